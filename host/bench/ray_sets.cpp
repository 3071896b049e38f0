// SPDX-License-Identifier: Apache-2.0
// Camera rays in tiles, and what follows from where they hit.
#include "host/bench/ray_sets.h"

#include "core/box.h"
#include "host/camera.h"
#include "host/memory_size.h"
#include "host/scene_summary.h"
#include "host/shade.h"
#include "testscenes/random.h"

#include <cassert>

namespace ovc {

/// How far off the surface rays begin, in diagonals of the scene: about a hundred float32
/// roundings.
static constexpr double kLiftOff = 1e-5;
static constexpr uint64_t kSeed = 1;

static std::vector<Ray> camera_rays(const Camera& camera, uint32_t width, uint32_t height,
                                    std::span<const uint32_t> pixels) {
    const Pinhole pinhole(camera, width, height);
    std::vector<Ray> rays;
    rays.reserve(pixels.size());
    for (const uint32_t pixel : pixels)
        rays.push_back(pinhole.ray(pixel % width, pixel / width));
    return rays;
}

/// Shirley and Chiu 1997: a point on the unit sphere around the normal's tip is, seen from its
/// foot, distributed as the cosine.
static dvec3 cosine_direction(const dvec3& normal, uint32_t pixel) {
    Random random(kSeed, pixel);
    const dvec3 direction = normal + random.direction();
    return glm::length(direction) > 1e-6 ? glm::normalize(direction) : normal;
}

Result<std::vector<RaySet>> make_ray_sets(const Scene& scene, const Camera& camera, uint32_t width,
                                          uint32_t height, Backend& reference) {
    assert(!scene.lights.empty());
    const std::vector<uint32_t> pixels = pixel_order(width, height);
    RaySet primary{"primary", RayQuery::Nearest, camera_rays(camera, width, height, pixels)};
    RaySet shadow{"shadow", RayQuery::Occlusion, {}};
    RaySet diffuse{"diffuse", RayQuery::Nearest, {}};

    std::vector<Hit> hits(primary.rays.size());
    if (const Result<Done> traced = reference.intersect(primary.rays, {}, hits); !traced)
        return traced.error();
    const Box bounds = hittable_bounds(scene.soup);
    const double lift = bounds.empty() ? 0 : kLiftOff * glm::length(bounds.hi - bounds.lo);
    for (size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].is_hit())
            continue;
        SurfacePoint point = surface_point(scene, primary.rays[i], hits[i]);
        const dvec3 normal(point.geometric_normal);
        point.position += lift * normal;
        shadow.rays.push_back(shadow_ray(scene.lights.front(), point.position));
        Ray bounce;
        bounce.org = point.position;
        bounce.dir = cosine_direction(normal, pixels[i]);
        diffuse.rays.push_back(bounce);
    }
    return std::vector<RaySet>{std::move(primary), std::move(shadow), std::move(diffuse)};
}

RaySet make_primary_set(const Camera& camera, uint32_t width, uint32_t height) {
    return {"primary " + human_count(uint64_t(width) * height), RayQuery::Nearest,
            camera_rays(camera, width, height, pixel_order(width, height))};
}

} // namespace ovc
