// SPDX-License-Identifier: Apache-2.0
// Scene: what an importer or a generated test scene hands to the host: soup, materials, lights,
// cameras.
#pragma once

#include "core/file/mapped_file.h"
#include "core/soup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// How a surface adds up light, as POV-Ray's finish does; shares need not sum to 1. POV-Ray's
/// pigment is Material::color; a pigment that lets light through has dimmed `ambient` and `diffuse`
/// already.
struct Finish {
    vec3 ambient{0};   // x color: what it sends out in the dark, the scene's ambient light in it
    float diffuse = 1; // x color x the light that arrives x cosine ^ brilliance
    float brilliance = 1;
    float phong = 0; // x the light that arrives x (reflected view . light) ^ phong_size
    float phong_size = 40;
    float specular = 0; // x the light that arrives x (half-way . normal) ^ (1 / roughness)
    float roughness = 0.05f;
    float metallic = 0; // highlights take the color on, more so away from grazing angles
    /// Reflected: seen head on, at a grazing angle, and the steepness between the two; or, with
    /// `fresnel`, between them by the material's ior.
    vec3 reflection{0};
    vec3 grazing_reflection{0};
    float reflection_falloff = 1;
    bool fresnel = false;
    float metallic_reflection = 0; // mirror images take the color on, as highlights do
    bool conserve_energy = false;  // what is reflected is not let through

    bool operator==(const Finish&) const = default;
};

/// The floor that is `color` and `other` by turns, in unit cubes of the space that `to_cubes` (rows
/// of a 3 x 4 affine matrix) leads to from the world.
struct Checker {
    vec3 other{0};
    std::array<dvec4, 3> to_cubes{};

    bool operator==(const Checker&) const = default;
};

/// What a surface is to light where its file says so, as physics has it: path tracing goes by this,
/// and Whitted's model by the rest of the material. Shares of light, linear RGB in [0, 1].
struct Optics {
    /// What reflects on top. None: nothing. Mirror: `reflection` at any angle. Metal: `reflection`
    /// head on, and all of it at grazing angles, as Schlick has it. Dielectric: `reflection` x what
    /// Fresnel's equations say of `ior`. Thin: the same for a pane, both of its sides together.
    enum class Boundary : uint8_t { None, Mirror, Metal, Dielectric, Thin };

    vec3 diffuse{0}; // scattered evenly, of what comes below the boundary
    Boundary boundary = Boundary::None;
    vec3 reflection{1};
    /// x what the boundary does not reflect goes on; bent by Material::ior, which is 1 but for
    /// Dielectric.
    vec3 through{0};
    double ior = 1.5;
    float width = 0;        // of the slopes of microfacets, GGX's alpha; 0: smooth
    vec3 emission{0};       // radiance, in the units of Light::color over distance squared
    bool two_sided = false; // emits from its back too

    bool operator==(const Optics&) const = default;
};

/// Whitted's surface, linear RGB in [0, 1]. Of the light that it sends on, `mirror` is the share
/// reflected as by a mirror and `transmission` the share let through, tinted by `filter` at every
/// crossing; the rest, at least 0, is the surface's own color. ior: of the inside of a closed mesh
/// of outward triangles (counterclockwise seen from outside), usable; the outside has 1. An open
/// mesh is a boundary between the two, met from either side. With a `finish`, parts are added up
/// instead of shared out: `mirror` only says whether there is a reflection, and `transmission`
/// takes nothing from the rest.
struct Material {
    std::string name;
    vec3 color{0.8f};
    float mirror = 0;
    float transmission = 0;
    vec3 filter{1};
    double ior = 1;
    std::optional<Finish> finish;
    std::optional<Checker> checker;
    std::optional<Optics> optics;

    bool operator==(const Material&) const = default;
};

/// Far beyond any material, and near enough for its square to be a number.
inline bool is_usable_ior(double ior) {
    return ior >= 1e-6 && ior <= 1e6;
}

/// What the host must know of a mesh besides its triangles. Scene::meshes[m] belongs to
/// Scene::soup.chunks[m].
struct MeshInfo {
    std::string name;
    uint32_t material = 0; // index into Scene::materials
    std::vector<vec3>
        normals; // 3 per triangle, unit length, or empty: then the triangle's own normal shades it
    bool no_shadow = false; // light passes as if it were not there
    /// Instances share normals: this mesh has those of that one, in the same order, turned.
    uint32_t normals_from = kNone;
    dmat3 turn{1}; // what `normals` are multiplied by; their length does not matter then
    /// Corners that have them in the file, and not here: normals that cannot be used or say nothing
    /// new, and texture coordinates, for no material of ours has textures.
    uint64_t normals_left_out = 0;
    uint64_t texture_coordinates_left_out = 0;
};

/// The cone of a spotlight: full light within radius_cosine of the axis, none beyond
/// falloff_cosine, smooth in between; all of it x cosine ^ tightness. As POV-Ray's.
struct SpotCone {
    double radius_cosine = 0.866;
    double falloff_cosine = 0.707;
    double tightness = 0;
};

/// Emits evenly; arrives as color / pi x the cosine, without fall-off, as POV-Ray's light_source
/// does by default.
struct Light {
    dvec3 position{0};
    vec3 color{1};
    bool on_camera = false; // position is where it is mounted: an offset from the eye
    /// The axis of a spotlight, or the way parallel light goes; unit length.
    dvec3 direction{0, 0, -1};
    std::optional<SpotCone> cone; // a spotlight
    /// All light goes along `direction`, from the plane through `position` across it; what is
    /// behind that plane is lit too, as in POV-Ray.
    bool parallel = false;
    bool shadowless = false; // shines through everything, and makes no highlights
    /// Not 0: arrives x 2 / (1 + (distance / fade_distance) ^ fade_power). Light that falls with
    /// the square of the distance: a tiny fade_distance D, power 2, and color / (2 D^2).
    double fade_distance = 0;
    double fade_power = 0;
    /// Stands for light that path tracing finds by itself: that of emitters and of the sky.
    bool stand_in = false;
};

/// The image as a window at the end of `direction` from the eye, `right` wide and `up` high,
/// whatever the image's size; of any handedness. Orthographic: rays begin in the window's plane
/// through the eye, and all go along `direction`.
struct ImageWindow {
    /// How the picture is bent, as POV-Ray's cameras of these names do it; Flat: not at all. All
    /// others are seen over `angle` and `vertical_angle` and take `right` and `up` for shape only.
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
};

/// A perspective camera. fov_degrees: the full angle of view along the image's shorter side.
struct Camera {
    dvec3 eye{0, 0, 1};
    dvec3 target{0};
    dvec3 up{0, 1, 0};
    double fov_degrees = 40;
    /// Decides instead of target, up and fov_degrees, which then say about the same: they are what
    /// "up" is for the background and where a light over the shoulder stands.
    std::optional<ImageWindow> window;
};

struct ImageSize {
    uint32_t width = 512;
    uint32_t height = 512;
};

/// What a ray that hits nothing sees: a gradient from horizon to zenith along the camera's up,
/// linear RGB.
struct Background {
    vec3 horizon{0.8f};
    vec3 zenith{0.35f, 0.5f, 0.8f};

    bool operator==(const Background&) const = default;
};

/// Scene::gamma: sRGB's curve instead of a power.
inline constexpr double kSrgbGamma = 0;

/// Of a color of a scene with that gamma: the linear light that it means.
inline float linear_light(float color, double gamma) {
    if (gamma != kSrgbGamma)
        return std::pow(std::max(color, 0.0f), float(gamma));
    return color <= 0.04045f ? std::max(color, 0.0f) / 12.92f
                             : std::pow((color + 0.055f) / 1.055f, 2.4f); // IEC 61966-2-1
}

/// What a scene was before its instances were expanded.
struct Instancing {
    uint64_t unique_triangles = 0;
    uint64_t instances = 0;
};

struct Scene {
    std::string name;
    Soup soup;
    std::vector<MeshInfo> meshes;
    std::vector<Material> materials;
    std::vector<Light> lights;
    bool may_add_light = true;         // where there are none, the host adds one beside the camera
    std::optional<Camera> camera;      // none: the host frames the bounds
    std::optional<ImageSize> size;     // of the picture that the file asks for
    std::optional<uint32_t> max_depth; // reflections and refractions in a row; none: the host's
    Background background;
    float exposure = 1; // what lights, background and emission were multiplied by to fit a picture
    /// What is rendered ^ gamma is linear light: POV-Ray's assumed_gamma; or kSrgbGamma.
    double gamma = 1;
    std::optional<Instancing> instancing; // none: every triangle is its own
    std::vector<MappedFile> files; // where chunks and `saved` lie that do not own what they show
    Bytes saved; // what the plugin saved of this soup (ovc_scene_config.saved); empty: nothing

    /// 3 per triangle, to be turned by MeshInfo::turn; empty: the mesh has none.
    const std::vector<vec3>& normals_of(const MeshInfo& mesh) const {
        return mesh.normals_from == kNone ? mesh.normals : meshes[mesh.normals_from].normals;
    }

    /// Appends a mesh of `material`; returns its number.
    uint32_t add_mesh(std::string mesh_name, uint32_t material, Chunk chunk,
                      std::vector<vec3> normals = {}) {
        soup.chunks.push_back(std::move(chunk));
        meshes.push_back({std::move(mesh_name), material, std::move(normals)});
        return uint32_t(meshes.size() - 1);
    }
};

} // namespace ovc
