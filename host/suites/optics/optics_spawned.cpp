// SPDX-License-Identifier: Apache-2.0
// Follows light into closed shapes and out again, and checks at every step that it meets the side
// of the surface that it must.
#include "host/suites/optics/optics_spawned.h"

#include "host/shade/shade.h"
#include "host/suites/optics/optics_shapes.h"
#include "testscenes/random.h"

#include <algorithm>

namespace ovc {

namespace {

constexpr size_t kBatch = 1 << 16;
constexpr uint64_t kRaysPerShape = 100; // in the short form, before they spawn
constexpr uint32_t kDepth = 6;

/// A ray that left shape `shape`, or, at depth 0, is aimed at it.
struct SpawnedRay {
    Ray ray;
    TriangleId skip;
    uint32_t shape;
    uint32_t depth;
    bool inside;
};

/// Returns a ray from outside all shapes towards a vertex of a triangle, a point of an edge or of
/// the inside.
SpawnedRay aimed(const ShapeField& field, uint32_t shape, Random& random) {
    const Chunk& chunk = field.scene.soup.chunks[shape];
    const Triangle t = field.scene.soup.triangle({shape, random.below(chunk.size())});
    const uint32_t kind = random.below(3);
    const double v = kind == 0 ? 0 : random.uniform(), w = kind == 2 ? random.uniform() : 0;
    const dvec3 target = t[0] + v * (t[1] - t[0]) + (1 - v) * w * (t[2] - t[0]);
    SpawnedRay ray{{}, {}, shape, 0, false};
    ray.ray.org = chunk.origin() + 2.2 * field.scale * random.direction();
    ray.ray.dir = target - ray.ray.org;
    return ray;
}

class Follower {
public:
    Follower(const ShapeField& field, Backend& backend, uint64_t seed)
        : field_(field), backend_(backend), random_(seed) {}

    /// Follows the light of one batch of rays until it is lost or has met kDepth surfaces.
    Result<Done> follow(std::vector<SpawnedRay> spawned) {
        while (!spawned.empty()) {
            rays_.clear();
            skip_.clear();
            for (const SpawnedRay& ray : spawned) {
                rays_.push_back(ray.ray);
                skip_.push_back(ray.skip);
            }
            hits_.resize(spawned.size());
            if (const Result<Done> done = backend_.intersect(rays_, skip_, hits_); !done)
                return done;
            std::vector<SpawnedRay> next;
            for (size_t i = 0; i < spawned.size(); ++i)
                judge(spawned[i], hits_[i], next);
            spawned = std::move(next);
        }
        return Done{};
    }

    const OpticsScore& score() const { return score_; }

private:
    void judge(const SpawnedRay& ray, const Hit& hit, std::vector<SpawnedRay>& next) {
        score_.rays += ray.depth > 0;
        const bool own = hit.is_hit() && hit.id.mesh == ray.shape;
        if (!own) {
            score_.leaks += ray.inside;
            return;
        }
        const SurfacePoint surface = surface_point(field_.scene, ray.ray, hit);
        if (ray.depth > 0) {
            const bool again = !ray.inside && field_.convex[ray.shape];
            score_.wrong += again || surface.entering == ray.inside;
        }
        // An aimed ray that grazes a corner may hit the far side instead.
        if (surface.entering != ray.inside && ray.depth < kDepth)
            spawn(ray, hit, surface, next);
    }

    void spawn(const SpawnedRay& ray, const Hit& hit, const SurfacePoint& surface,
               std::vector<SpawnedRay>& next) {
        const std::optional<Ray> refraction = refracted_ray(ray.ray, surface);
        // Only the first surface spawns both rays, because otherwise they would double at each.
        const bool both = ray.depth == 0, through = random_.chance(0.5);
        SpawnedRay spawned{{}, hit.id, ray.shape, ray.depth + 1, ray.inside};
        if (both || !through || !refraction) {
            spawned.ray = mirror_ray(ray.ray, surface);
            next.push_back(spawned);
        }
        if (refraction && (both || through)) {
            spawned.ray = *refraction;
            spawned.inside = !ray.inside;
            next.push_back(spawned);
        }
    }

    const ShapeField& field_;
    Backend& backend_;
    Random random_;
    OpticsScore score_;
    std::vector<Ray> rays_;
    std::vector<TriangleId> skip_;
    std::vector<Hit> hits_;
};

} // namespace

Result<OpticsScore> spawned_rays(const OpticsOptions& options, const LogSink& log, double scale) {
    const ShapeField field = make_shape_field(options.shapes, scale);
    const Result<std::unique_ptr<Backend>> backend =
        make_backend(field.scene.soup, options.backend, log);
    if (!backend)
        return backend.error();
    Random random(/* seed= */ 3);
    Follower follower(field, **backend, /* seed= */ 4);
    std::vector<SpawnedRay> spawned;
    const uint64_t rounds = kRaysPerShape * options.times;
    for (uint64_t round = 0; round < rounds; ++round) {
        for (uint32_t shape = 0; shape < options.shapes; ++shape)
            spawned.push_back(aimed(field, shape, random));
        if (spawned.size() < kBatch && round + 1 < rounds)
            continue;
        if (const Result<Done> done = follower.follow(std::exchange(spawned, {})); !done)
            return done.error();
    }
    return follower.score();
}

} // namespace ovc
