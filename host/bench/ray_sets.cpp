// SPDX-License-Identifier: Apache-2.0
// Makes camera rays, and the shadow, diffuse and edge rays that follow from their hits.
#include "host/bench/ray_sets.h"

#include "core/box.h"
#include "core/exact/triangle.h"
#include "host/arguments/memory_size.h"
#include "host/camera/camera.h"
#include "host/scene/scene_summary.h"
#include "host/shade/shade.h"
#include "testscenes/random.h"

namespace ovc {

/// Rays begin so many diagonals of the scene off the surface: about a hundred float32 roundings.
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

/// Returns a direction distributed as the cosine to the normal: a uniform point on the unit sphere
/// around the normal's tip, seen from its foot (Shirley and Chiu 1997).
static dvec3 cosine_direction(const dvec3& normal, uint32_t pixel) {
    Random random(kSeed, pixel);
    const dvec3 direction = normal + random.direction();
    return glm::length(direction) > 1e-6 ? glm::normalize(direction) : normal;
}

Result<RaySetAnswers> answers_of(const RaySet& set, Backend& backend) {
    const bool nearest = set.query == RayQuery::Nearest;
    RaySetAnswers answers;
    answers.hits.resize(nearest ? set.rays.size() : 0);
    answers.occluded.resize(nearest ? 0 : set.rays.size());
    const Result<Done> done = nearest ? backend.intersect(set.rays, {}, answers.hits)
                                      : backend.occluded(set.rays, {}, answers.occluded);
    return done ? Result<RaySetAnswers>(std::move(answers)) : done.error();
}

Camera own_or_framing_camera(const Scene& scene, uint32_t width, uint32_t height) {
    return scene.camera ? *scene.camera
                        : framing_camera(hittable_bounds(scene.soup), width, height);
}

Result<std::vector<RaySet>> make_ray_sets(const Scene& scene, const Camera& camera, uint32_t width,
                                          uint32_t height, Backend& reference) {
    const Light light = scene.lights.empty() ? shoulder_light(camera) : scene.lights.front();
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
        shadow.rays.push_back(shadow_ray(light, point.position));
        Ray bounce;
        bounce.org = point.position;
        bounce.dir = cosine_direction(normal, pixels[i]);
        diffuse.rays.push_back(bounce);
    }
    return std::vector<RaySet>{std::move(primary), std::move(shadow), std::move(diffuse)};
}

/// Returns a corner or, as often, a point between a corner and the next.
static dvec3 target_of(const Triangle& triangle, Random& random) {
    const uint32_t corner = random.below(3);
    const double along = random.chance(0.5) ? 0 : random.uniform();
    return glm::mix(triangle[corner], triangle[(corner + 1) % 3], along);
}

Result<RaySet> make_edge_set(const Scene& scene, const Camera& camera, uint32_t width,
                             uint32_t height, Backend& reference) {
    const std::vector<uint32_t> pixels = pixel_order(width, height);
    const std::vector<Ray> from = camera_rays(camera, width, height, pixels);
    std::vector<Hit> hits(from.size());
    if (const Result<Done> traced = reference.intersect(from, {}, hits); !traced)
        return traced.error();
    RaySet edges{"edges", RayQuery::Nearest, {}};
    for (size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].is_hit())
            continue;
        Random random(kSeed, pixels[i]);
        Ray ray = from[i];
        ray.dir = glm::normalize(target_of(scene.soup.triangle(hits[i].id), random) - ray.org);
        edges.rays.push_back(ray);
    }
    return edges;
}

RaySet make_primary_set(const Camera& camera, uint32_t width, uint32_t height) {
    return {"primary " + human_count(uint64_t(width) * height), RayQuery::Nearest,
            camera_rays(camera, width, height, pixel_order(width, height))};
}

} // namespace ovc
