// SPDX-License-Identifier: Apache-2.0
// The textures that the scene evaluates, with pbrt's mappings. Each mapping is a part of the
// picture or pattern itself.
#include "core/texture/noise/perlin.h"
#include "importers/file/picture_path.h"
#include "importers/file/text.h"
#include "importers/pbrt/interpret/left_over.h"
#include "importers/pbrt/look/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

namespace {

using Projection = ImageTexture::Projection;

/// A mapping: the steps to s and t, and what is left to a projection.
struct Mapping {
    bool on_uv = false;
    std::vector<TextureStep> steps;
    Projection projection = Projection::Planar;
    std::array<dvec3, 2> to_picture{dvec3(1, 0, 0), dvec3(0, 1, 0)};
};

TextureStep affine(const dvec4& x, const dvec4& y, const dvec4& z) {
    return {TextureStep::Kind::Affine, {x, y, z}};
}

/// Returns the step from the world to the texture's own space.
TextureStep to_own_space(const dmat4& to_world) {
    const dmat4 m = glm::inverse(to_world);
    const auto row = [&](int i) { return dvec4(m[0][i], m[1][i], m[2][i], m[3][i]); };
    return affine(row(0), row(1), row(2));
}

/// Returns nothing for a mapping that pbrt does not have.
std::optional<Mapping> mapping_of(const TextureRequest& request) {
    const Parameters& p = request.parameters;
    const std::string name = p.text("mapping", "uv");
    Mapping mapping;
    const double ds = p.number("udelta", 0), dt = p.number("vdelta", 0);
    if (name == "uv") {
        mapping.on_uv = true;
        mapping.steps = {affine({p.number("uscale", 1), 0, 0, ds},
                                {0, p.number("vscale", 1), 0, dt}, {0, 0, 1, 0})};
        return mapping;
    }
    mapping.steps = {to_own_space(request.to_world)};
    if (name == "planar") {
        const dvec3 v1 = p.point("v1", dvec3(1, 0, 0)), v2 = p.point("v2", dvec3(0, 1, 0));
        mapping.steps.push_back(affine(dvec4(v1, ds), dvec4(v2, dt), dvec4(0)));
        return mapping;
    }
    if (name == "spherical") { // s: the angle from +z down, t: that around z, both as shares
        mapping.projection = Projection::LatLong;
        mapping.to_picture = {dvec3(0, -1, 1), dvec3(1, 0, 0)};
        return mapping;
    }
    if (name != "cylindrical")
        return std::nullopt;
    mapping.projection = Projection::Cylindrical; // around z, from -x on; t: z
    mapping.steps.push_back(affine({-1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}));
    return mapping;
}

/// Returns the power that turns codes into light: 0 for sRGB's curve, which is the default. v4 says
/// "encoding", v3 whether there is a gamma, v2 the power.
double gamma_of(const Parameters& p) {
    const std::string encoding = p.text("encoding");
    if (encoding == "linear" || !p.flag("gamma", true))
        return 1;
    if (encoding.starts_with("gamma")) {
        const auto power = parse_double(trimmed(std::string_view(encoding).substr(5)));
        return power && *power > 0 && *power < 100 ? *power : 2.2;
    }
    const double power = p.number("gamma", 0);
    return power > 0 && power < 100 ? power : 0;
}

Beyond beyond_of(const Parameters& p) {
    const std::string wrap = p.text("wrap", "repeat");
    return wrap == "clamp" ? Beyond::Clamp : wrap == "black" ? Beyond::Nothing : Beyond::Repeat;
}

TexelFilter filter_of(const Parameters& p) {
    const std::string filter = p.text("filter");
    return filter == "point"      ? TexelFilter::Nearest
           : filter == "bilinear" ? TexelFilter::Smooth
                                  : TexelFilter::Mipmaps;
}

} // namespace

uint32_t Textures::image(const std::string& file, const Place& place, ImageTexture image,
                         bool on_uv) {
    const auto found = tokens_.find(file);
    const std::string folder =
        place.file ? std::filesystem::path(*place.file).parent_path().string() : "";
    const std::string path = found ? std::filesystem::absolute(*found).lexically_normal().string()
                                   : picture_path(folder, file);
    image.picture = add_picture(
        scene_, path, place.file ? fmt::format("{}:{}", *place.file, place.line) : std::string());
    Texture texture;
    texture.kind = TextureKind::Image;
    texture.on_uv = on_uv;
    texture.image = image;
    return add_texture(scene_, std::move(texture));
}

/// Warns of a word that pbrt refuses. What it says then counts as if it were not there.
void Textures::check_word(const Parameters& p, std::string_view name,
                          std::initializer_list<std::string_view> known) const {
    const std::string word = p.text(name);
    if (!word.empty() && std::ranges::find(known, std::string_view(word)) == known.end())
        diagnostics_.missing(
            fmt::format("{} {}", name, word), p.find(name)->place,
            fmt::format("the {} {} of a texture left out: it is unknown", name, ovc::quoted(word)));
}

std::optional<uint32_t> Textures::make_image(const TextureRequest& request) {
    const Parameters& p = request.parameters;
    const std::optional<Mapping> mapping = mapping_of(request);
    const std::string file = p.text("filename");
    if (!mapping || file.empty())
        return std::nullopt;
    check_word(p, "wrap", {"repeat", "clamp", "black", "octahedralsphere"});
    if (p.text("wrap") == "octahedralsphere")
        diagnostics_.approximate("wrap", p.find("wrap")->place,
                                 "textures that wrap around a sphere are repeated");
    check_word(p, "filter", {"point", "bilinear", "trilinear", "EWA", "ewa"});
    if (!p.text("encoding").starts_with("gamma"))
        check_word(p, "encoding", {"sRGB", "linear"});
    ImageTexture picture;
    picture.projection = mapping->projection;
    picture.to_picture = mapping->to_picture;
    picture.beyond_s = picture.beyond_t = beyond_of(p);
    picture.filter = filter_of(p);
    picture.gamma = gamma_of(p);
    if (request.is_float && is_v4_) // the opacity is the number there
        picture.channel = ImageTexture::Channel::CodedMask;
    const bool inverted = p.flag("invert", false);
    picture.scale = vec3(float(p.number("scale", 1)) * (inverted ? -1 : 1));
    picture.offset = vec3(inverted ? 1 : 0);
    picture.otherwise = {mean(request.type, p)};
    const uint32_t made = image(file, request.place, picture, mapping->on_uv);
    scene_.textures[made].pattern.steps = mapping->steps;
    return made;
}

/// Returns what a parameter of a texture is: a color, or another texture. Nothing: that is shown
/// by its mean.
std::optional<TextureStop> Textures::stop(const Definition& definition, std::string_view name,
                                          const vec3& otherwise) {
    const auto part = definition.parts.find(name);
    if (part == definition.parts.end() || !definitions_[part->second].is_pattern)
        return TextureStop{0, {color(definition.request.parameters, name, otherwise)}, kNoTexture};
    const auto made = make(part->second);
    return made ? std::optional(TextureStop{0, {}, *made}) : std::nullopt;
}

std::optional<uint32_t> Textures::make_combined(const Definition& definition, TextureKind kind,
                                                std::initializer_list<std::string_view> names) {
    Texture texture;
    texture.kind = kind;
    for (const std::string_view name : names) {
        const float otherwise = name == "amount"                             ? 0.5f
                                : name == "tex1" && kind == TextureKind::Mix ? 0
                                                                             : 1;
        const std::optional<TextureStop> one = stop(definition, name, vec3(otherwise));
        if (!one)
            return std::nullopt;
        texture.stops.push_back(*one);
    }
    return add_texture(scene_, std::move(texture));
}

/// Returns a texture whose pattern lies on a mapping of planes; nothing for another mapping.
static std::optional<Texture> on_plane(const std::optional<Mapping>& mapping, Pattern::Kind kind) {
    if (!mapping || mapping->projection != Projection::Planar)
        return std::nullopt;
    Texture texture;
    texture.on_uv = mapping->on_uv;
    texture.pattern.kind = kind;
    texture.pattern.steps = mapping->steps;
    return texture;
}

/// In two dimensions the board lies on a mapping, in three in the texture's space.
std::optional<uint32_t> Textures::make_checkerboard(const Definition& definition) {
    const TextureRequest& request = definition.request;
    Mapping solid;
    solid.steps = {to_own_space(request.to_world)};
    const std::optional<Mapping> mapping =
        request.parameters.number("dimension", 2) == 3 ? solid : mapping_of(request);
    std::optional<Texture> texture = on_plane(mapping, Pattern::Kind::Checker);
    return texture ? make_choice(definition, std::move(*texture), {"tex1", "tex2"}) : std::nullopt;
}

std::optional<uint32_t> Textures::make_choice(const Definition& definition, Texture texture,
                                              const std::array<std::string_view, 2>& names) {
    for (const std::string_view name : names) {
        const vec3 otherwise(name == "tex1" || name == "inside" ? 1.0f : 0.0f);
        const std::optional<TextureStop> one = stop(definition, name, otherwise);
        if (!one)
            return std::nullopt;
        texture.stops.push_back(*one);
    }
    return add_texture(scene_, std::move(texture));
}

/// All versions of pbrt show "inside" around the dots and "outside" in them.
std::optional<uint32_t> Textures::make_dots(const Definition& definition) {
    std::optional<Texture> texture = on_plane(mapping_of(definition.request), Pattern::Kind::Dots);
    return texture ? make_choice(definition, std::move(*texture), {"inside", "outside"})
                   : std::nullopt;
}

/// The colors of the corners are mixed along t, and the two that come of it along s.
std::optional<uint32_t> Textures::make_bilerp(const Definition& definition) {
    const std::optional<Texture> plane =
        on_plane(mapping_of(definition.request), Pattern::Kind::Function);
    if (!plane)
        return std::nullopt;
    const auto share_along = [&](uint32_t axis) {
        Texture share = *plane;
        share.pattern.wave = Pattern::Wave::None;
        share.pattern.formula = {{{FormulaStep::Kind::Argument, axis}}, {1}};
        share.stops = {{0, {vec3(0)}}, {1, {vec3(1)}}};
        return TextureStop{0, {}, add_texture(scene_, std::move(share))};
    };
    const auto mixed = [&](TextureStop low, TextureStop high, TextureStop share) {
        return TextureStop{0, {}, mix(low, high, share)};
    };
    std::vector<TextureStop> corners;
    for (const std::string_view name : {"v00", "v01", "v10", "v11"}) {
        const std::optional<TextureStop> one =
            stop(definition, name, vec3(name.back() == '1' ? 1.0f : 0.0f));
        if (!one)
            return std::nullopt;
        corners.push_back(*one);
    }
    const TextureStop s = share_along(0), t = share_along(1);
    return mixed(mixed(corners[0], corners[1], t), mixed(corners[2], corners[3], t), s).texture;
}

/// Returns the colors of marble as stops: Bezier's cubics through nine colors, each over four in a
/// row, as straight pieces.
/// Based on: Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", section 10.6.6.
static std::vector<TextureStop> marble_stops() {
    constexpr vec3 kLight(0.58f, 0.58f, 0.6f);
    constexpr std::array<vec3, 9> kColors = {kLight,
                                             kLight,
                                             kLight,
                                             vec3(0.5f),
                                             vec3(0.6f, 0.59f, 0.58f),
                                             kLight,
                                             kLight,
                                             vec3(0.2f, 0.2f, 0.33f),
                                             kLight};
    constexpr float kBrighter = 1.5f;
    constexpr size_t kCubics = kColors.size() - 3, kPieces = 8;
    std::vector<TextureStop> stops;
    for (size_t cubic = 0; cubic < kCubics; ++cubic)
        for (size_t piece = 0; piece <= kPieces; ++piece) {
            const float t = float(piece) / float(kPieces), s = 1 - t;
            const vec3 color = s * s * s * kColors[cubic] + 3 * s * s * t * kColors[cubic + 1] +
                               3 * s * t * t * kColors[cubic + 2] + t * t * t * kColors[cubic + 3];
            stops.push_back({(double(cubic) + double(t)) / double(kCubics), {kBrighter * color}});
        }
    return stops;
}

uint32_t Textures::make_noise(const TextureRequest& request) {
    using P = PerlinParameter;
    const Parameters& p = request.parameters;
    const std::string& type = request.type;
    Texture texture;
    Pattern& pattern = texture.pattern;
    pattern.kind = Pattern::Kind::Perlin;
    pattern.wave = Pattern::Wave::None;
    pattern.steps = {to_own_space(request.to_world)};
    texture.stops = {{0, {vec3(0)}}, {1, {vec3(1)}}};
    pattern.parameters[P::kForm] = type == "wrinkled" ? P::Turbulence
                                   : type == "windy"  ? P::Windy
                                   : type == "marble" ? P::Marble
                                                      : P::Sum;
    pattern.parameters[P::kOctaves] = std::clamp(p.number("octaves", 8), 0.0, kMaxNoiseOctaves);
    pattern.parameters[P::kRoughness] = p.number("roughness", 0.5);
    if (type == "marble") {
        const double scale = p.number("scale", 1);
        pattern.wave = Pattern::Wave::Ramp;
        pattern.parameters[P::kVariation] = p.number("variation", 0.2);
        pattern.steps.push_back(affine({scale, 0, 0, 0}, {0, scale, 0, 0}, {0, 0, scale, 0}));
        texture.stops = marble_stops();
    }
    return add_texture(scene_, std::move(texture));
}

/// A texture's parts were defined before it, so that they are made before it, too.
std::optional<uint32_t> Textures::make(size_t number) {
    assert(number < definitions_.size());
    Definition& definition = definitions_[number];
    if (definition.is_made)
        return definition.made;
    definition.is_made = true;
    const std::string& type = definition.request.type;
    const Parameters& p = definition.request.parameters;
    if (type == "imagemap")
        definition.made = make_image(definition.request);
    else if (type == "checkerboard")
        definition.made = make_checkerboard(definition);
    else if (type == "dots")
        definition.made = make_dots(definition);
    else if (type == "bilerp")
        definition.made = make_bilerp(definition);
    else if (type == "fbm" || type == "wrinkled" || type == "windy" || type == "marble")
        definition.made = make_noise(definition.request);
    else if (type == "scale" && (p.find("tex") || p.find("scale"))) // v4's names
        definition.made = make_combined(definition, TextureKind::Product, {"tex", "scale"});
    else if (type == "scale")
        definition.made = make_combined(definition, TextureKind::Product, {"tex1", "tex2"});
    else if (type == "mix")
        definition.made = make_combined(definition, TextureKind::Mix, {"tex1", "tex2", "amount"});
    if (!definition.made)
        tell_mean(type, definition.request.place);
    return definition.made;
}

std::optional<uint32_t> Textures::texture(const Parameters& parameters, std::string_view name) {
    const Definition* const found = find(parameters, name);
    if (!found || !found->is_pattern)
        return std::nullopt;
    const std::optional<uint32_t> made = make(size_t(found - definitions_.data()));
    parameters.find(name)->evaluated = made.has_value();
    return made;
}

uint32_t Textures::product(uint32_t texture, const vec3& color) {
    if (color == vec3(1))
        return texture;
    Texture both;
    both.kind = TextureKind::Product;
    both.stops = {{0, {}, texture}, {0, {color}, kNoTexture}};
    return add_texture(scene_, std::move(both));
}

uint32_t Textures::mix(const TextureStop& low, const TextureStop& high, const TextureStop& share) {
    Texture mix;
    mix.kind = TextureKind::Mix;
    mix.stops = {low, high, share};
    return add_texture(scene_, std::move(mix));
}

uint32_t Textures::average(std::vector<TextureStop> stops) {
    Texture average;
    average.pattern.kind = Pattern::Kind::Average;
    average.stops = std::move(stops);
    return add_texture(scene_, std::move(average));
}

bool Textures::is_on_uv(uint32_t texture) const {
    return textures_on_uv(scene_.textures, std::vector<bool>(scene_.textures.size()))[texture];
}

void Textures::take(Scene& scene) {
    for (const Definition& definition : definitions_)
        if (definition.made)
            tell_left_over(definition.request.parameters, "textures", definition.request.type,
                           diagnostics_);
    scene.textures = std::move(scene_.textures);
    scene.pictures = std::move(scene_.pictures);
}

} // namespace ovc::pbrt
