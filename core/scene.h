// SPDX-License-Identifier: Apache-2.0
// Scene: the soup, materials, lights and camera that an importer or a generated test scene hands to
// the host.
#pragma once

#include "core/cutout.h"
#include "core/face_camera.h"
#include "core/file/mapped_file.h"
#include "core/file/scene_on_disk.h"
#include "core/medium.h"
#include "core/soup.h"
#include "core/texture/bump.h"
#include "core/texture/normal_map.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

/// How a surface adds up light, as POV-Ray's finish does; shares need not sum to 1. POV-Ray's
/// pigment is Material::color. Where a pigment lets light through, the importer has dimmed
/// `ambient` and `diffuse` already.
struct Finish {
    vec3 ambient{0};        // x color is sent out in the dark; the scene's ambient light is in it
    vec3 emission{0};       // the part of `ambient` that does not stand for light of other surfaces
    float diffuse = 1;      // x color x the light that arrives x cosine ^ brilliance
    float diffuse_back = 0; // the same of light that arrives at the side that is not seen
    float brilliance = 1;
    float phong = 0; // x the light that arrives x (reflected view . light) ^ phong_size
    float phong_size = 40;
    float specular = 0; // x the light that arrives x (half-way . normal) ^ (1 / roughness)
    float roughness = 0.05f;
    float metallic = 0; // highlights take the color on, more so away from grazing angles
    /// The share that is reflected head on, the one at a grazing angle, and the steepness between
    /// the two. With `fresnel` the material's ior decides between them instead.
    vec3 reflection{0};
    vec3 grazing_reflection{0};
    float reflection_falloff = 1;
    bool fresnel = false;
    float metallic_reflection = 0; // mirror images take the color on, as highlights do
    bool conserve_energy = false;  // reflected light is not let through, too
    /// The share of a thin film's colors in the light of a lamp. The film's thickness has the unit
    /// of the wavelengths of red, green and blue light, and varies in space by this turbulence.
    float irid = 0;
    float irid_thickness = 0;
    float irid_turbulence = 0;
    NoiseKind irid_noise = NoiseKind::Corrected;
    vec3 irid_wavelengths{0.7f, 0.52f, 0.48f};
    float crand = 0; // up to this share of diffuse light is missing, at random from place to place
    /// A filter hides the surface's own light in proportion to its brightest component, as before
    /// POV-Ray 3.7, and not by its amount.
    bool filter_by_brightest = false;

    bool operator==(const Finish&) const = default;
};

/// Light that went a distance through the inside of a solid keeps a share of 1 / (1 + (way /
/// distance) ^ power), and the rest of a component of light keeps the share of `color`. For a power
/// of 1,000 or more it keeps exp(-(1 - color) x way / distance). With a power of 0 shadows keep all
/// light.
struct Absorption {
    float distance = 0; // above 0
    float power = 0;    // at least 0
    vec3 color{0};

    bool operator==(const Absorption&) const = default;
};

/// How a surface treats light physically, where its file says so. Path tracing goes by this, and
/// Whitted's model by the rest of the material. Shares of light are linear RGB in [0, 1].
struct Optics {
    /// The boundary on top, which reflects. None reflects nothing, and Mirror `reflection` at any
    /// angle. Metal reflects `reflection` head on and all light at grazing angles, by Schlick's
    /// formula. Dielectric reflects `reflection` x the share that Fresnel's equations give for
    /// `ior`. Thin does the same for a pane, both of its sides together.
    enum class Boundary : uint8_t { None, Mirror, Metal, Dielectric, Thin };

    vec3 diffuse{0};        // scattered evenly, of the light below the boundary
    vec3 diffuse_behind{0}; // the same to the other side, which leaves share 1 - diffuse for it
    /// A Dielectric throws part of the scattered light back down, which is then scattered again:
    /// less comes out of a dark `diffuse`. Else that is what comes out in all.
    bool internal_reflection = false;
    Boundary boundary = Boundary::None;
    vec3 reflection{1};
    /// The share of the light not reflected by the boundary that goes on through the surface, bent
    /// by Material::ior, which is 1 for all boundaries except Dielectric.
    vec3 through{0};
    double ior = 1.5;
    float width = 0;        // GGX's alpha, of the slopes of microfacets; 0: smooth
    vec3 emission{0};       // radiance, in the units of Light::color over distance squared
    bool two_sided = false; // emits from its back too

    bool operator==(const Optics&) const = default;
};

/// Textures over parts of a material besides its color, as indices into Scene::textures; kNone: the
/// part is the same everywhere. They are evaluated at points of the world.
struct MaterialMaps {
    uint32_t reflection = kNone; // multiplies Optics::reflection, and mirror images and highlights
    uint32_t width = kNone;      // multiplies Optics::width
    uint32_t emission = kNone;   // multiplies Optics::emission
    /// The share of metal. The boundary then reflects, head on, 0.04 and of metal the color, and
    /// only the rest scatters: glTF's model.
    uint32_t metallic = kNone;

    bool operator==(const MaterialMaps&) const = default;
};

/// A surface of Whitted's model, linear RGB in [0, 1]. Of the light that it sends on, it reflects
/// the share `mirror` as a mirror does and lets the share `transmission` through, tinted by
/// `filter` at every crossing; the rest, at least 0, is the surface's own color.
///
/// `ior` is that of the inside of a closed mesh of outward triangles (counterclockwise seen from
/// outside), and usable; the outside has 1. An open mesh is a boundary between the two, met from
/// either side. With a `finish`, parts are added up instead of shared out: `mirror` only says
/// whether there is a reflection, and `transmission` takes nothing from the rest.
struct Material {
    std::string name;
    vec3 color{0.8f};
    float mirror = 0;
    float transmission = 0;
    vec3 filter{1};
    double ior = 1;
    std::optional<Finish> finish;
    std::optional<Optics> optics;
    /// The color, and with a finish the light that goes through: color_at() takes the place of
    /// `color`, and its through() x `transmission` that of transmission x filter. `transmission` is
    /// 0 where no color of the texture lets light through.
    std::optional<PlacedTexture> texture;
    std::optional<Bump> bump; // tilts the normals
    std::optional<NormalMap> normal_map;
    std::optional<MaterialMaps> maps;
    /// The material below, an index into Scene::materials. It is seen in the light that this one
    /// lets through. Its own layers follow; kNone: there is none.
    uint32_t under = kNone;
    /// Mixes materials in proportion, as a texture does colors: its stops' `texture` are indices
    /// into Scene::materials. This material then only says what the rest of the scene asks of it.
    std::optional<PlacedTexture> mix;
    std::optional<Absorption> absorption; // of light that comes to the surface from inside
    std::vector<Medium> media;            // that fill the inside
    bool hollow = false; // what fills the air, as fog does, and all media fill the inside too
    /// POV-Ray's substitute for focused light: shadow rays that pass the surface are multiplied by
    /// 1 + cosine ^ (45 x caustics), with the angle to the normal; 0: they are not.
    float caustics = 0;
    /// The material of the surface's inner side, an index into Scene::materials; kNone: this one.
    uint32_t inside = kNone;

    bool operator==(const Material&) const = default;
};

/// Returns whether ior is in a range that exceeds all materials, and whose squares are numbers.
inline bool is_usable_ior(double ior) {
    return ior >= 1e-6 && ior <= 1e6;
}

/// The rays that see a mesh, as bits of its chunk's mask. A chunk of mask 0 is seen by all rays.
enum SeenBy : uint32_t {
    kSeenByCamera = 1,      // rays that come from the camera, through glass too
    kSeenInReflections = 2, // rays that a surface has reflected, mirrors or others, on their way
    kShadowsLights = 4,     // shadow rays towards Scene::lights
    kShadowsEmitters = 8,   // shadow rays towards a point of an emitting mesh
    kShadowsStandIns = 16,  // shadow rays towards those lights that stand for emitters
    kShadowsAll = 28,
    kSeenByAll = 31,
    kSeenByNone = 32 // a mesh that only emits
};

/// Which lights shine on a mesh, as POV-Ray's light_group has it: those of its group, and those of
/// no group unless it keeps to its own.
struct LitBy {
    uint32_t group = kNone; // Light::group
    bool group_alone = false;

    bool includes(uint32_t light_group) const {
        return light_group == kNone ? !group_alone : light_group == group;
    }

    auto operator<=>(const LitBy&) const = default;
};

/// The host's knowledge of a mesh besides its triangles. Scene::meshes[m] belongs to
/// Scene::soup.chunks[m].
struct MeshInfo {
    std::string name;
    uint32_t material = 0; // index into Scene::materials
    /// 3 per triangle, unit length; or empty, and then the triangle's own normal shades it.
    std::vector<vec3> normals;
    /// The mesh whose normals this one shares, turned by `turn`; kNone: its own. Instances use it.
    uint32_t normals_from = kNone;
    dmat3 turn{1}; // multiplies those normals, whose length then does not matter
    LitBy lit_by;
    /// Indices into Scene::cutouts of what all rays see of the mesh, and shadow rays besides;
    /// kNone: it has no holes.
    uint32_t cutout = kNone;
    uint32_t shadow_cutout = kNone;
    /// 3 per triangle for a mesh that has a use for them, or those of another mesh; else empty.
    std::vector<vec2> uv;
    uint32_t uv_from = kNone;
    /// The triangles stand for a curved surface through their corners that has their normals.
    /// Textures are evaluated on it.
    bool curved = false;
    /// Where normals and texture coordinates lie on a disk instead (Scene::on_disk); or null.
    const StoredValues* stored_normals = nullptr;
    const StoredValues* stored_uv = nullptr;
    /// Counts the corners that have these in the file and not here: normals that cannot be used or
    /// say nothing new, and texture coordinates that neither a cutout nor a texture has a use for.
    uint64_t normals_left_out = 0;
    uint64_t texture_coordinates_left_out = 0;
};

/// The cone of a spotlight, as POV-Ray's: the light is full within radius_cosine of the axis, none
/// beyond falloff_cosine and smooth in between, and all of it is multiplied by cosine ^ tightness.
struct SpotCone {
    double radius_cosine = 0.866;
    double falloff_cosine = 0.707;
    double tightness = 0;
};

/// The beam of a cylinder of light, as POV-Ray's: the light is full within `radius` of the axis,
/// none beyond `falloff` (> 0) and smooth in between, and all of it is multiplied by (1 - distance
/// from the axis / falloff) ^ tightness.
struct LightBeam {
    double radius = 0;
    double falloff = 1;
    double tightness = 0;
};

/// A picture that a light throws: its color is multiplied by the picture's.
struct ThrownPicture {
    PlacedTexture texture; // leads from a way from the light, of unit length, to its space
    /// The light shines through a window at z = 1 of that space, which has the picture's shape and
    /// whose shorter side goes from -1 to 1. The picture fills it, from 0 to 1 along both sides.
    bool has_window = false;

    /// Returns where the window, of this width by its height, lets a way of the texture's space
    /// through, in the picture's x and y; nothing where it does not.
    static std::optional<dvec2> through_window(const dvec3& way, double shape) {
        constexpr double kMinAhead = 1e-3; // flatter ways go through none, as in pbrt
        const dvec2 at = dvec2(way) / way.z / glm::max(dvec2(shape, 1 / shape), 1.0);
        const bool goes = way.z >= kMinAhead && std::abs(at.x) <= 1 && std::abs(at.y) <= 1;
        return goes ? std::optional(0.5 * (at + 1.0)) : std::nullopt;
    }
};

/// A light that emits evenly. Its light arrives as color / pi x the cosine, without fall-off, as
/// that of POV-Ray's light_source does by default.
struct Light {
    dvec3 position{0};
    vec3 color{1};
    bool on_camera = false; // mounted on the camera: position is an offset from the eye
    /// The axis of a spotlight, or the direction in which parallel light goes; unit length.
    dvec3 direction{0, 0, -1};
    std::optional<SpotCone> cone;  // of a spotlight
    std::optional<LightBeam> beam; // of a cylinder of light, which is parallel
    /// All light goes along `direction`, from the plane through `position` that is perpendicular to
    /// it. Surfaces behind that plane are lit too, as in POV-Ray.
    bool parallel = false;
    /// Parallel light comes from beyond all surfaces, and `position` does not count.
    bool distant = false;
    bool shadowless = false;   // shines through everything, and makes no highlights
    bool lights_media = true;  // media scatter it
    bool fades_in_air = false; // fog and media of the air take their share of it
    /// Unless 0, the light is multiplied by 2 / (1 + (distance / fade_distance) ^ fade_power).
    /// Light that falls with the square of the distance has a tiny fade_distance D, power 2, color
    /// / (2 D^2).
    double fade_distance = 0;
    double fade_power = 0;
    /// The light stands for emitters or the sky, whose light path tracing finds by itself.
    bool stand_in = false;
    /// Shadow rays go to position + shadow_offset, a point of an area light whose light has its
    /// direction and strength from its middle, as POV-Ray's has without area_illumination.
    dvec3 shadow_offset{0};
    /// The area light faces the place that it lights, as POV-Ray's with `orient`: x of the offset
    /// is along towards x the z axis, y across that and the way to the light, and z is 0.
    bool faces_places = false;
    /// The lights that are points of one area light, and stand side by side; 1: it is a point.
    uint32_t area_points = 1;
    /// Surfaces nearer to the light than this throw no shadow, such as the one that it lies on.
    double clearance = 0;
    uint32_t group = kNone; // of lights and meshes; kNone: shines on all that LitBy lets it
    /// An object that is not seen, as POV-Ray's projected_through: only light whose way goes
    /// through its surface arrives, and only what lies between there and the place casts shadows.
    std::optional<Region> projector;
    std::optional<ThrownPicture> thrown;
};

/// The image is a window at the end of `direction` from the eye, `right` wide and `up` high, and of
/// any handedness. With `orthographic`, rays begin in the window's plane through the eye, and all
/// go along `direction`.
struct ImageWindow {
    /// How the picture is bent, as by POV-Ray's cameras of these names; Flat is not bent. All
    /// others cover `angle` and `vertical_angle`, and take only the shape from `right` and `up`.
    enum class Bend {
        Flat,
        Fisheye,
        UltraWide,
        Omnimax,
        Panoramic,
        Spherical,
        Cylinder1,
        Cylinder2,
        Cylinder3,
        Cylinder4
    };

    dvec3 direction{0, 0, 1};
    dvec3 right{1.33, 0, 0};
    dvec3 up{0, 1, 0};
    bool orthographic = false;
    Bend bend = Bend::Flat;
    double angle = 90; // degrees, across the picture
    double vertical_angle = 90;
    /// The width by the height of the picture that `right` and `up` are for. In a picture of
    /// another shape the shorter side shows what it does in that one, and the longer side more or
    /// less of what there is, so that nothing is stretched. 0: all pictures show the window.
    double shape = 0;
};

/// A thin lens, which is sharp at one depth. Rays begin on the ellipse around the eye whose half
/// axes are `right` and `up`.
struct Lens {
    dvec3 right{0};
    dvec3 up{0};
    double focus = 1; // where rays through one place of the picture meet: their t, above 0

    bool operator==(const Lens&) const = default;
};

/// A perspective camera. fov_degrees: the full angle of view along the image's shorter side, or its
/// height.
struct Camera {
    dvec3 eye{0, 0, 1};
    dvec3 target{0};
    dvec3 up{0, 1, 0};
    double fov_degrees = 40;
    bool fov_is_upright = false; // along the height of every picture, as in glTF
    /// If set, it decides the view instead of target, up and fov_degrees. Those then hold about the
    /// same view: the background takes its "up" from them, and a light over the shoulder its place.
    std::optional<ImageWindow> window;
    /// Tilts the rays' directions. Its space is that of the picture, from -0.5 to 0.5 from left to
    /// right and from bottom to top. Its textures are those of the scene.
    std::optional<Bump> bump;
    std::optional<Lens> lens; // none: everything is sharp, as it is in a bent picture
    double nearest = 0;       // distance from which on rays see something
    bool by_faces = false;    // rays come from Scene::faces, and the rest says about where they go
};

struct ImageSize {
    uint32_t width = 512;
    uint32_t height = 512;
};

/// A part of a larger picture, at `left` and `top` pixels from its left and upper edge.
struct PicturePart {
    ImageSize picture;
    uint32_t left = 0;
    uint32_t top = 0;
    ImageSize size;

    /// Returns the number in the picture of a pixel of the part, both counted row by row. Random
    /// numbers go by it, so that a part has the noise of the whole picture.
    uint32_t number_in_picture(uint32_t pixel) const {
        return (top + pixel / size.width) * picture.width + left + pixel % size.width;
    }

    bool lies_in_picture() const {
        return size.width >= 1 && size.height >= 1 &&
               uint64_t(left) + size.width <= picture.width &&
               uint64_t(top) + size.height <= picture.height;
    }
};

/// Mist in the air. Of light that goes a way through it, the share exp(-way / distance) is left,
/// and the fog's own color takes the place of the rest.
struct Fog {
    TransparentColor color; // at least the share `transmit` is left; `filter` of that is tinted
    double distance = 1;    // above 0
    /// Unless 0, the fog is a layer on the ground: it is full below `offset` along `up`, and above
    /// that it is thinner by 1 / (1 + (height / altitude)^2).
    double altitude = 0;
    double offset = 0;
    dvec3 up{0, 1, 0}; // unit length
    /// Unless 0, noise thins the fog: the share `turbulence_depth` of it at
    /// the middle of a ray's way, whose coordinates are multiplied by this.
    dvec3 turbulence{0};
    double turbulence_depth = 0.5;
    Octaves octaves;
    NoiseKind noise = NoiseKind::Corrected;

    bool operator==(const Fog&) const = default;
};

/// A bow of colors in the air, as thick as fog, around the way that sunlight goes.
struct Rainbow {
    dvec3 direction{0, 0, 1}; // of sunlight; unit length
    dvec3 up{0, 1, 0};        // from the middle of the bow to that of its arc; any length above 0
    double angle = 0;         // degrees from `direction` to the middle of the colors
    double width = 0;         // degrees from the first color to the last; above 0
    double distance = 1e7;    // as Fog::distance; above 0
    double arc = 360;         // degrees of the circle that are seen; above 0
    double full_arc = 360;    // degrees of it that are not fading out
    double jitter = 0;        // by which colors are at random places, as a share of the width
    std::vector<TextureStop> colors; // from the inner rim, 0, to the outer one, 1; at least one

    bool operator==(const Rainbow&) const = default;
};

/// The light that a ray sees where it hits nothing: a gradient from horizon to zenith along the
/// camera's up, linear RGB. In front of it are the layers, the farthest first, each a texture on a
/// sphere of radius 1 around the eye.
struct Background {
    vec3 horizon{0.8f};
    vec3 zenith{0.35f, 0.5f, 0.8f};
    std::vector<PlacedTexture> layers;
    bool tints = true;       // what a layer's filter lets through takes on its color
    bool layers_add = false; // the light of opaque layers is added to that behind them
    std::vector<Fog> fogs;
    std::vector<Rainbow> rainbows;
    std::vector<Medium> media; // that fill the air, outside of solids

    bool operator==(const Background&) const = default;
};

/// Diffuse light that goes from surface to surface, as POV-Ray's radiosity. Finishes reflect it in
/// place of their ambient light.
struct Radiosity {
    uint32_t bounces = 2; // at least 1: from lit surfaces, from those that they light, …
    float brightness = 1; // multiplies the light of the bounces

    bool operator==(const Radiosity&) const = default;
};

/// The Scene::gamma that stands for sRGB's curve instead of a power.
inline constexpr double kSrgbGamma = 0;

/// Returns the linear light of a color in a scene with that gamma; a negative color counts as 0.
inline float linear_light(float color, double gamma) {
    if (gamma != kSrgbGamma)
        return std::pow(std::max(color, 0.0f), float(gamma));
    return color <= 0.04045f ? std::max(color, 0.0f) / 12.92f
                             : std::pow((color + 0.055f) / 1.055f, 2.4f); // IEC 61966-2-1
}

/// A file that a texture shows.
struct PictureFile {
    std::string file;
    std::string asked_for_at;      // the place that names it, "a.pbrt:12:3"; or empty
    std::vector<uint8_t> contents; // of a picture that lies in another file; else empty

    bool operator==(const PictureFile&) const = default;
};

/// The size of a scene before its instances were expanded.
struct Instancing {
    uint64_t unique_triangles = 0;
    uint64_t instances = 0;
};

/// A kind of thing that is not drawn as its file's author meant, and how often it comes.
struct Omission {
    std::string sentence;
    uint64_t count = 0;

    bool operator==(const Omission&) const = default;
};

struct Scene {
    std::string name;
    Soup soup;
    std::vector<MeshInfo> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures; // a texture's stops name textures before it
    std::vector<PictureFile> pictures;
    std::vector<Bump> bumps; // parts of those of materials, each made of ones before it
    std::vector<Cutout> cutouts;
    std::vector<Light> lights;
    bool moves = false;                // something in it goes by the Moment
    bool may_add_light = true;         // without lights the host adds one beside the camera
    std::optional<Camera> camera;      // none: the host frames the bounds
    std::optional<FaceCamera> faces;   // of a camera by_faces
    std::optional<ImageSize> size;     // of the picture, where the file asks for one
    std::optional<PicturePart> part;   // of it that is rendered; none: all
    std::optional<uint32_t> max_depth; // reflections and refractions in a row; none: the host's
    std::optional<uint32_t> samples;   // rays a pixel that its camera takes; none: the host's
    Background background;
    std::optional<Radiosity> radiosity;
    float exposure = 1; // lights, background and emission were multiplied by it to fit a picture
    /// POV-Ray's assumed_gamma: a rendered value ^ gamma is linear light. Or kSrgbGamma.
    double gamma = 1;
    std::vector<Omission> omissions;      // as far as the importer counts them
    std::optional<Instancing> instancing; // none: the file has no instances
    std::vector<MappedFile> files;        // hold the bytes of borrowing chunks and of `saved`
    Bytes saved; // levels that the plugin saved (ovc_scene_config.saved), or empty
    std::unique_ptr<SceneOnDisk> on_disk; // of a scene that need not fit into memory; else null

    /// Returns 3 normals per triangle, to be turned by MeshInfo::turn; none if the mesh has none.
    PerCorner<vec3> normals_of(const MeshInfo& mesh) const {
        assert(mesh.normals_from == kNone || mesh.normals_from < meshes.size());
        const MeshInfo& of = mesh.normals_from == kNone ? mesh : meshes[mesh.normals_from];
        return of.stored_normals ? PerCorner<vec3>(*of.stored_normals)
                                 : PerCorner<vec3>(of.normals);
    }

    /// Returns 3 texture coordinates per triangle; none if the mesh has none.
    PerCorner<vec2> uv_of(const MeshInfo& mesh) const {
        assert(mesh.uv_from == kNone || mesh.uv_from < meshes.size());
        const MeshInfo& of = mesh.uv_from == kNone ? mesh : meshes[mesh.uv_from];
        return of.stored_uv ? PerCorner<vec2>(*of.stored_uv) : PerCorner<vec2>(of.uv);
    }

    /// Lets the rays of these kinds (SeenBy) see a mesh, and no others.
    void show(uint32_t mesh, uint32_t seen_by) {
        assert(mesh < soup.chunks.size() && seen_by != 0); // a mesh that none sees is left out
        soup.chunks[mesh].set_mask(seen_by == kSeenByAll ? 0 : seen_by);
    }

    /// Appends a mesh of `material`; returns its number.
    uint32_t add_mesh(std::string mesh_name, uint32_t material, Chunk chunk,
                      std::vector<vec3> normals = {}) {
        soup.chunks.push_back(std::move(chunk));
        meshes.push_back({std::move(mesh_name), material, std::move(normals)});
        assert(meshes.size() == soup.chunks.size());
        return uint32_t(meshes.size() - 1);
    }
};

/// Returns for each texture whether it has a part that lies on texture coordinates. mixes: for each
/// texture whether its stops are materials.
std::vector<bool> textures_on_uv(std::span<const Texture> textures, const std::vector<bool>& mixes);

/// Returns for each material whether it has a use for texture coordinates. Its textures must be
/// sound.
std::vector<bool> materials_on_uv(const Scene& scene);

} // namespace ovc
