// SPDX-License-Identifier: Apache-2.0
// Shading: what a hit looks like by itself, before shadows and reflections, and the rays that leave
// it. Whitted's model on two-sided surfaces.
#pragma once

#include "core/ray.h"
#include "core/scene.h"

#include <cstdint>
#include <optional>

namespace ovc {

/// A point on a surface as a ray saw it: both normals face the ray and are of unit length.
struct SurfacePoint {
    dvec3 position;         // just on the ray's side of the triangle
    dvec3 beyond;           // just on the other side
    dvec3 geometric_normal; // of the triangle's plane
    dvec3 normal;           // interpolated where the mesh has normals, else the geometric one
    dvec3 view;             // the ray's direction, of unit length
    const Material* material;
    vec3 color;    // the material's here
    bool entering; // the ray came from outside: from where the corners run counterclockwise
};

/// Where a ray hit. Both positions lie off the triangle by far less than float can tell but more
/// than double errs, so that a second triangle in the same place is neither a shadow nor a second
/// surface; near an edge they are also moved into the triangle, as its neighbour may bend towards
/// either side. The triangle itself is left out of spawned rays by its id.
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit);

/// What a ray in direction `dir` sees that hits nothing. up: unit length.
vec3 background_color(const Background& background, const vec3& up, const dvec3& dir);

/// Light from the sky and, weaker, from the ground, without shadows: the radiance the surface
/// reflects of it.
vec3 ambient_light(const Background& background, const vec3& up, const SurfacePoint& surface);

/// What a light brings to a place if nothing is in between.
struct FromLight {
    dvec3 towards{0}; // the light, unit length; 0: it is right there
    vec3 color{0};    // of the light, as far as it comes this way and so far
};
FromLight light_at(const Light& light, const dvec3& position);

/// What the surface reflects of `light` when nothing is in between; 0 when the light is behind it.
vec3 direct_light(const Light& light, const SurfacePoint& surface);

/// From `position` to the light: t = 1 is the light.
Ray shadow_ray(const Light& light, const dvec3& position);

/// The light that the rays which leave a surface bring, as shares of it for each color; and what
/// the surface's own color loses to each ray that is followed.
struct Branches {
    vec3 mirror{0};
    vec3 through{0};
    float taken_by_mirror = 0;
    float taken_by_through = 0;
};

/// total: nothing goes through, all of it is reflected.
Branches branches(const SurfacePoint& surface, bool total);

/// The mirrored ray; never goes below the triangle's plane.
Ray mirror_ray(const Ray& ray, const SurfacePoint& surface);

/// The ray that goes on beyond the surface, on the other side of the triangle's plane; nothing
/// where the light is reflected totally.
std::optional<Ray> refracted_ray(const Ray& ray, const SurfacePoint& surface);

} // namespace ovc
