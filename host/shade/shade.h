// SPDX-License-Identifier: Apache-2.0
// Shading of a single hit, before shadows and reflections, and the rays that leave it, by Whitted's
// model on two-sided surfaces.
#pragma once

#include "core/ray.h"
#include "core/scene.h"
#include "host/shade/cone.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

struct Coat;

/// The values of a material's maps at a point: factors of the parts that they are for.
struct MapValues {
    vec3 reflection{1};
    vec3 emission{1};
    float width = 1;
    float metal = -1; // the share of metal; below 0: there is no such map

    /// Returns the factor of mirror images and highlights.
    float gloss() const { return (reflection.x + reflection.y + reflection.z) / 3; }
};

/// A point on a surface as a ray saw it: both normals face the ray and are of unit length.
struct SurfacePoint {
    dvec3 position;         // just on the ray's side of the triangle
    dvec3 beyond;           // just on the other side
    dvec3 geometric_normal; // of the triangle's plane
    dvec3 normal;           // interpolated where the mesh has normals, else the geometric one
    dvec3 view;             // the ray's direction, of unit length
    const Material* material;
    vec3 color;        // the material's color here
    float opacity = 1; // multiplies ambient and diffuse light; 1 where the finish is dimmed already
    vec3 through{0};   // with a finish: the share of light that goes through here, for each color
    MapValues maps;
    bool entering;         // the ray came from outside, from where the corners run counterclockwise
    double ior_around = 1; // the index of refraction of what the surface's solid lies in
    LitBy lit_by;
    /// The parts of a material that is layered or mixed; else empty. `color` is then their mean.
    std::vector<Coat> coats;
};

/// Returns the optics of the point's material, which has some, there.
Optics optics_at(const SurfacePoint& surface);

/// A surface point with one material, and the share of it that is seen, for each color.
struct Coat {
    SurfacePoint surface; // without coats
    vec3 weight;
    /// Its share in mixes alone. As in POV-Ray, what lies over a mirror does not dim it.
    float share = 1;
};

/// Returns whether some texture or normal map is seen as a mean over the cones of rays.
bool needs_cones(const Scene& scene);

/// Returns the point where a ray hit; hit: no miss. Both positions lie off the triangle by far less
/// than float can tell but more than double errs, so that a second triangle in the same place is
/// neither a shadow nor a second surface. Near an edge they are also moved into the triangle, since
/// its neighbour may bend towards either side. Spawned rays skip the triangle itself by its id.
/// cone: of the ray; without one, textures are seen at a point.
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit,
                           const Cone& cone = {});

/// Returns the color that a ray in direction `dir` sees where it hits nothing. up: unit length.
vec3 background_color(const Scene& scene, const vec3& up, const dvec3& dir);

/// Returns the radiance that the surface reflects of light from the sky and, weaker, from the
/// ground, without shadows.
vec3 ambient_light(const Background& background, const vec3& up, const SurfacePoint& surface);

/// Returns the vector from the position to the light, at its full length; of 1 to a distant one.
dvec3 towards_light(const Light& light, const dvec3& position);

/// The light that a lamp brings to a place if nothing is in between, without the picture that it
/// throws (lights/thrown_light.h).
struct FromLight {
    dvec3 towards{0}; // the lamp, unit length; 0: it is at this very place
    vec3 color{0};    // after its cone and its fall-off with distance
};
FromLight light_at(const Light& light, const dvec3& position);

/// Returns the light that the surface reflects of `light` if nothing is in between; 0 where the
/// light is behind it.
vec3 direct_light(const Light& light, const SurfacePoint& surface);

/// Returns the ray from `position` to the light, which is at t = 1 or distant, up to where it casts
/// shadows.
Ray shadow_ray(const Light& light, const dvec3& position);

/// The shares, for each color, of the light that the rays leaving a surface bring, and the shares
/// that its own color loses to each ray that is followed.
struct Branches {
    vec3 mirror{0};
    vec3 through{0};
    float taken_by_mirror = 0;
    float taken_by_through = 0;
};

/// Returns the shares of a surface. total: nothing goes through, and all light is reflected.
Branches branches(const SurfacePoint& surface, bool total);

/// Returns the share, for each color, that is left of light after the ray's way to the surface from
/// inside of its solid.
vec3 share_kept(const Ray& ray, const SurfacePoint& surface);
/// Returns the same for a shadow ray, which nothing is taken from where the absorption's power is
/// 0.
vec3 share_kept_in_shadow(const Ray& ray, const SurfacePoint& surface);

/// Returns the mirrored ray, which never goes below the triangle's plane.
Ray mirror_ray(const Ray& ray, const SurfacePoint& surface);

/// Returns the ray that goes on beyond the surface, on the other side of the triangle's plane;
/// nothing where the light is reflected totally.
std::optional<Ray> refracted_ray(const Ray& ray, const SurfacePoint& surface);

} // namespace ovc
