// SPDX-License-Identifier: Apache-2.0
// Scene: what an importer or a generated test scene hands to the host: soup, materials, lights,
// cameras.
#pragma once

#include "core/soup.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// Whitted's surface, linear RGB in [0, 1]. Of the light that it sends on, `mirror` is the share
/// reflected as by a mirror and `transmission` the share let through, tinted by `filter` at every
/// crossing; the rest, at least 0, is the surface's own color. ior: of the inside of a closed mesh
/// of outward triangles (counterclockwise seen from outside), usable; the outside has 1. An open
/// mesh is a boundary between the two, met from either side.
struct Material {
    std::string name;
    vec3 color{0.8f};
    float mirror = 0;
    float transmission = 0;
    vec3 filter{1};
    double ior = 1;

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
};

/// Emits evenly; arrives as color / pi x the cosine, without fall-off, as POV-Ray's light_source
/// does by default.
struct PointLight {
    dvec3 position{0};
    vec3 color{1};
    bool on_camera = false; // position is where it is mounted: an offset from the eye
};

/// A perspective camera. fov_degrees: the full angle of view along the image's shorter side.
struct Camera {
    dvec3 eye{0, 0, 1};
    dvec3 target{0};
    dvec3 up{0, 1, 0};
    double fov_degrees = 40;
};

/// What a ray that hits nothing sees: a gradient from horizon to zenith along the camera's up,
/// linear RGB.
struct Background {
    vec3 horizon{0.8f};
    vec3 zenith{0.35f, 0.5f, 0.8f};
};

struct Scene {
    std::string name;
    Soup soup;
    std::vector<MeshInfo> meshes;
    std::vector<Material> materials;
    std::vector<PointLight> lights; // empty: the host adds one beside the camera
    std::optional<Camera> camera;   // none: the host frames the bounds
    Background background;

    /// Appends a mesh of `material`; returns its number.
    uint32_t add_mesh(std::string mesh_name, uint32_t material, Chunk chunk,
                      std::vector<vec3> normals = {}) {
        soup.chunks.push_back(std::move(chunk));
        meshes.push_back({std::move(mesh_name), material, std::move(normals)});
        return uint32_t(meshes.size() - 1);
    }
};

} // namespace ovc
