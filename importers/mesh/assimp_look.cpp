// SPDX-License-Identifier: Apache-2.0
// Sources: Khronos, "glTF 2.0", sections 3.9 and appendix B; KHR_texture_transform and
// KHR_lights_punctual.
#include "importers/mesh/assimp_look.h"

#include "core/text/lower_case.h"
#include "importers/file/picture_path.h"
#include "importers/file/text.h"
#include "importers/mesh/clear_optics.h"
#include "importers/pbrt/look/area_lights.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

namespace {

/// The textures of glTF that we show, and those of other formats that mean the same.
constexpr aiTextureType kColorMaps[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
constexpr aiTextureType kMetalMaps[] = {aiTextureType_UNKNOWN, aiTextureType_METALNESS};
constexpr aiTextureType kNormalMaps[] = {aiTextureType_NORMALS};
constexpr aiTextureType kEmissionMaps[] = {aiTextureType_EMISSIVE};

vec3 color_of(const aiMaterial& source, const char* key, unsigned type, unsigned index,
              const vec3& otherwise) {
    aiColor3D color;
    if (source.Get(key, type, index, color) != AI_SUCCESS)
        return otherwise;
    const vec3 rgb(color.r, color.g, color.b);
    return is_finite(rgb) ? rgb : otherwise;
}

float number_of(const aiMaterial& source, const char* key, unsigned type, unsigned index,
                float otherwise) {
    ai_real number = 0;
    return source.Get(key, type, index, number) == AI_SUCCESS && std::isfinite(number)
               ? float(number)
               : otherwise;
}

Beyond beyond_of(const aiMaterial& source, const char* key, aiTextureType type) {
    int mode = aiTextureMapMode_Wrap;
    source.Get(key, type, 0, mode);
    return mode == aiTextureMapMode_Clamp    ? Beyond::Clamp
           : mode == aiTextureMapMode_Mirror ? Beyond::Mirror
           : mode == aiTextureMapMode_Decal  ? Beyond::Nothing
                                             : Beyond::Repeat;
}

/// Returns the rows of to_picture. Assimp 5 gives the angle with its sign changed, and an offset
/// for turning around the middle of the picture with v upwards.
std::array<dvec3, 2> placement_of(const aiMaterial& source, aiTextureType type) {
    aiUVTransform t;
    if (source.Get(AI_MATKEY_UVTRANSFORM(type, 0), t) != AI_SUCCESS)
        return {dvec3(1, 0, 0), dvec3(0, 1, 0)};
    const double c = std::cos(double(t.mRotation)), s = -std::sin(double(t.mRotation));
    const double sx = t.mScaling.x, sy = t.mScaling.y;
    // glTF's offsets, from those that Assimp has made of them.
    const double ox = t.mTranslation.x - 0.5 * sx * (1 - c + s);
    const double oy = 0.5 * sy * (c + s - 1) + 1 - sy - t.mTranslation.y;
    // With v downwards: u' = c sx u + s sy v + ox and v' = -s sx u + c sy v + oy.
    return {dvec3(c * sx, -s * sy, s * sy + ox), dvec3(s * sx, c * sy, 1 - c * sy - oy)};
}

bool is_collada(const std::filesystem::path& file) {
    const auto name = file.extension() == ".gz" ? file.stem() : file;
    const std::string extension = lower_case(name.extension().string());
    return extension == ".dae" || extension == ".zae";
}

bool has_invisible_material(const aiScene& found) {
    return std::any_of(
        found.mMaterials, found.mMaterials + found.mNumMaterials,
        [](const aiMaterial* each) { return number_of(*each, AI_MATKEY_OPACITY, 1) == 0; });
}

class Looks {
public:
    Looks(const aiScene& found, const std::filesystem::path& file, Scene& scene)
        : found_(found),
          file_(file),
          scene_(scene),
          opacity_is_transparency_(is_collada(file) && has_invisible_material(found)) {}

    AssimpMaterial add(const aiMaterial& source);

    /// The pictures that some material shows.
    std::vector<std::string> shown;

private:
    /// A picture of a material, and where it lies.
    struct Image {
        ImageTexture image;
        uint32_t uv_set = 0;
    };

    std::optional<Image> image_of(const aiMaterial& source, std::span<const aiTextureType> types,
                                  double gamma);
    std::optional<uint32_t> picture_of(const std::string& name);
    uint32_t add_image(const Image& image);
    void add_optics(const aiMaterial& source, Material& material);
    void add_emission(const aiMaterial& source, const vec3& emission, Material& material);
    void add_holes(const aiMaterial& source, const Image& color, AssimpMaterial& to);
    float opacity_of(const aiMaterial& source) const;
    void let_light_through(const aiMaterial& source, bool has_holes, Material& material) const;

    const aiScene& found_;
    const std::filesystem::path& file_;
    Scene& scene_;
    /// Some programs write <transparency> of COLLADA the other way round, and 0 for what is opaque.
    const bool opacity_is_transparency_;
};

/// Finds a picture: "*0" is one within the file.
std::optional<uint32_t> Looks::picture_of(const std::string& name) {
    const std::string place = file_.string();
    const aiTexture* const within = found_.GetEmbeddedTexture(name.c_str());
    if (!within)
        return add_picture(scene_, picture_path(file_.parent_path(), decoded_uri(name)), place);
    if (within->mHeight != 0) // texels without a format
        return std::nullopt;
    const uint32_t picture =
        add_picture(scene_, file_.filename().string() + ", picture " + name, place);
    const auto* bytes = reinterpret_cast<const uint8_t*>(within->pcData);
    scene_.pictures[picture].contents.assign(bytes, bytes + within->mWidth);
    return picture;
}

std::optional<Looks::Image> Looks::image_of(const aiMaterial& source,
                                            std::span<const aiTextureType> types, double gamma) {
    for (const aiTextureType type : types) {
        aiString path;
        if (source.GetTexture(type, 0, &path) != AI_SUCCESS || path.length == 0)
            continue;
        const std::optional<uint32_t> picture = picture_of(path.C_Str());
        if (!picture)
            continue;
        shown.push_back(path.C_Str());
        Image result;
        result.image.picture = *picture;
        result.image.to_picture = placement_of(source, type);
        result.image.beyond_s = beyond_of(source, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
        result.image.beyond_t = beyond_of(source, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
        result.image.gamma = gamma;
        int uv_set = 0;
        source.Get(AI_MATKEY_UVWSRC(type, 0), uv_set);
        result.uv_set = uint32_t(std::clamp(uv_set, 0, AI_MAX_NUMBER_OF_TEXTURECOORDS - 1));
        return result;
    }
    return std::nullopt;
}

uint32_t Looks::add_image(const Image& image) {
    Texture texture;
    texture.kind = TextureKind::Image;
    texture.on_uv = true;
    texture.image = image.image;
    return add_texture(scene_, std::move(texture));
}

/// Other formats than glTF have no factor for the picture.
vec3 emission_of(const aiMaterial& source, bool is_gltf) {
    const vec3 color = color_of(source, AI_MATKEY_COLOR_EMISSIVE, vec3(0));
    if (!is_gltf && color == vec3(0) && source.GetTextureCount(aiTextureType_EMISSIVE) > 0)
        return vec3(1);
    return number_of(source, AI_MATKEY_EMISSIVE_INTENSITY, 1) * glm::max(color, vec3(0));
}

/// Sets glTF's metallic-roughness model for path tracing: roughness is the root of the width.
void Looks::add_optics(const aiMaterial& source, Material& material) {
    const float metallic = number_of(source, AI_MATKEY_METALLIC_FACTOR, 0);
    const float roughness = number_of(source, AI_MATKEY_ROUGHNESS_FACTOR, 1);
    Optics& optics = material.optics.emplace();
    optics.diffuse = material.color;
    optics.boundary = Optics::Boundary::Metal;
    optics.reflection = vec3(1);
    optics.width = roughness * roughness;
    MaterialMaps& maps = material.maps.emplace();
    if (auto image = image_of(source, kMetalMaps, 1)) {
        image->image.otherwise = {vec3(1)};
        image->image.channel = ImageTexture::Channel::Green;
        const uint32_t rough = add_image(*image);
        Texture squared;
        squared.kind = TextureKind::Product;
        squared.stops = {{0, {}, rough}, {0, {}, rough}};
        maps.width = add_texture(scene_, std::move(squared));
        image->image.channel = ImageTexture::Channel::Blue;
        image->image.scale = vec3(metallic);
        image->image.otherwise = {vec3(metallic)};
        maps.metallic = add_image(*image);
    } else {
        maps.metallic = add_texture(scene_, plain_texture(vec3(metallic)));
    }
    add_emission(source, emission_of(source, /* is_gltf= */ true), material);
}

/// Lets a surface that has optics send out light.
void Looks::add_emission(const aiMaterial& source, const vec3& emission, Material& material) {
    std::optional<Image> image = image_of(source, kEmissionMaps, 0);
    if (emission == vec3(0))
        return;
    Optics& optics = *material.optics;
    optics.emission = emission;
    int two_sided = 0;
    source.Get(AI_MATKEY_TWOSIDED, two_sided);
    optics.two_sided = two_sided != 0;
    if (image) {
        image->image.otherwise = {vec3(1)};
        if (!material.maps)
            material.maps.emplace();
        material.maps->emission = add_image(*image);
    }
}

/// Returns glTF's alpha mode; nothing for other formats.
std::string alpha_mode_of(const aiMaterial& source) {
    aiString mode;
    return source.Get(AI_MATKEY_GLTF_ALPHAMODE, mode) == AI_SUCCESS ? mode.C_Str() : "";
}

float alpha_cutoff_of(const aiMaterial& source) {
    return std::max(number_of(source, AI_MATKEY_GLTF_ALPHACUTOFF, 0.5f), 1e-6f);
}

/// glTF's alpha: a mask, or a share of light that chance stands for.
void Looks::add_holes(const aiMaterial& source, const Image& color, AssimpMaterial& to) {
    const std::string mode = alpha_mode_of(source);
    if (mode != "MASK" && mode != "BLEND")
        return;
    Image opacity = color;
    opacity.image.channel = ImageTexture::Channel::Opacity;
    aiColor4D base(1, 1, 1, 1);
    source.Get(AI_MATKEY_BASE_COLOR, base);
    opacity.image.scale = vec3(float(base.a));
    opacity.image.offset = vec3(0);
    opacity.image.otherwise = {vec3(1)};
    Cutout cutout{.texture = add_image(opacity)};
    if (mode == "MASK")
        cutout.threshold = alpha_cutoff_of(source);
    to.cutout = uint32_t(scene_.cutouts.size());
    scene_.cutouts.push_back(std::move(cutout));
}

/// Returns the share of light that a surface without holes stops: of glTF all except for BLEND, and
/// none below the cutoff of a MASK.
float Looks::opacity_of(const aiMaterial& source) const {
    const std::string mode = alpha_mode_of(source);
    const float stated = number_of(source, AI_MATKEY_OPACITY, 1);
    const float alpha = opacity_is_transparency_ ? 1 - stated : stated;
    if (mode == "MASK")
        return alpha < alpha_cutoff_of(source) ? 0.0f : 1.0f;
    return mode == "OPAQUE" ? 1.0f : alpha;
}

/// The base color tints glTF's transmission, but not the opacity that other formats know.
void Looks::let_light_through(const aiMaterial& source, bool has_holes, Material& material) const {
    const float factor = number_of(source, AI_MATKEY_TRANSMISSION_FACTOR, 0);
    const float share = factor > 0 ? factor : 1 - (has_holes ? 1 : opacity_of(source));
    if (!(share > 0))
        return;
    material.transmission = std::min(share, 1.0f);
    material.filter = factor > 0 ? material.color : vec3(1);
    if (const float ior = number_of(source, AI_MATKEY_REFRACTI, 1); is_usable_ior(ior))
        material.ior = ior;
}

AssimpMaterial Looks::add(const aiMaterial& source) {
    AssimpMaterial result;
    Material material;
    material.name = source.GetName().C_Str();
    const vec3 factor =
        glm::clamp(color_of(source, AI_MATKEY_COLOR_DIFFUSE, material.color), vec3(0), vec3(1));
    material.color = factor;
    if (auto image = image_of(source, kColorMaps, 0)) {
        result.uv_set = image->uv_set;
        image->image.scale = factor;
        image->image.otherwise = {factor};
        add_holes(source, *image, result);
        material.texture = placed_in_world(add_image(*image));
    }
    if (auto image = image_of(source, kNormalMaps, 1)) {
        image->image.otherwise = {vec3(0.5f, 0.5f, 1)};
        const float scale =
            number_of(source, AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), 1);
        material.normal_map = NormalMap{NormalMap::Kind::Tangent, add_image(*image), double(scale)};
    }
    result.is_cut_away =
        result.cutout == kNone && alpha_mode_of(source) == "MASK" && opacity_of(source) == 0;
    let_light_through(source, result.cutout != kNone, material);
    ai_real metallic = 0; // glTF's model is that of materials that have it
    const bool is_gltf = source.Get(AI_MATKEY_METALLIC_FACTOR, metallic) == AI_SUCCESS;
    if (is_gltf && material.transmission == 0)
        add_optics(source, material);
    else if (const vec3 emission = emission_of(source, is_gltf); emission != vec3(0)) {
        material.optics = clear_optics(material);
        add_emission(source, emission, material);
    }
    scene_.materials.push_back(std::move(material));
    return result;
}

dvec3 vector_of(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

/// Returns nothing for a light of an area, and for one that no node has or that cannot be used.
std::optional<Light> light_from(const aiLight& source, const aiNode& root) {
    const std::optional<aiMatrix4x4> placed = place_of(root, source.mName);
    if (!placed)
        return std::nullopt;
    const aiMatrix4x4& place = *placed;
    Light light;
    light.position = vector_of(place * source.mPosition);
    const aiVector3D ahead =
        source.mDirection.SquareLength() > 0 ? source.mDirection : aiVector3D(0, 0, -1);
    const dvec3 direction = vector_of(place * (source.mPosition + ahead)) - light.position;
    const double length = glm::length(direction);
    const vec3 color(source.mColorDiffuse.r, source.mColorDiffuse.g, source.mColorDiffuse.b);
    if (!is_finite(light.position) || !is_finite(color) || !(length > 0) || !std::isfinite(length))
        return std::nullopt;
    light.direction = direction / length;
    switch (source.mType) {
    case aiLightSource_DIRECTIONAL:
        light.parallel = light.distant = true;
        light.color = color;
        return light;
    case aiLightSource_SPOT:
        light.cone = SpotCone{std::cos(double(source.mAngleInnerCone)),
                              std::cos(double(source.mAngleOuterCone)), 0};
        pbrt::set_falloff(light, color);
        return light;
    case aiLightSource_POINT:
        pbrt::set_falloff(light, color);
        return light;
    default:
        return std::nullopt;
    }
}

} // namespace

std::optional<aiMatrix4x4> place_of(const aiNode& root, const aiString& name) {
    const aiNode* node = root.FindNode(name);
    if (!node)
        return std::nullopt;
    aiMatrix4x4 place;
    for (; node; node = node->mParent)
        place = node->mTransformation * place;
    return place;
}

std::vector<AssimpMaterial> add_materials(const aiScene& found, const std::filesystem::path& file,
                                          Scene& scene, std::vector<std::string>& left_out) {
    Looks looks(found, file, scene);
    std::vector<AssimpMaterial> materials;
    for (unsigned m = 0; m < found.mNumMaterials; ++m)
        materials.push_back(looks.add(*found.mMaterials[m]));
    std::erase_if(left_out, [&](const std::string& name) {
        return std::ranges::find(looks.shown, name) != looks.shown.end();
    });
    return materials;
}

uint64_t add_lights(const aiScene& found, Scene& scene) {
    uint64_t left_out = 0;
    for (unsigned l = 0; l < found.mNumLights; ++l)
        if (const auto light = light_from(*found.mLights[l], *found.mRootNode))
            scene.lights.push_back(*light);
        else
            ++left_out;
    if (!scene.lights.empty())
        scene.background = {vec3(0), vec3(0)}; // ours is for scenes that have no light
    return left_out;
}

} // namespace ovc
