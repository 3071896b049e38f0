// SPDX-License-Identifier: Apache-2.0
// Rays, right answers and a stream's host, which the tests of every structure share.
#pragma once

#include "core/stream/stream.h"
#include "kdtree/test_soups.h"
#include "plugin/structure/structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

namespace ovc::test {

inline std::vector<Ray> rays_from_outside(uint64_t seed, size_t count) {
    Random random(seed);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.org = random.point(-1, 1) + dvec3(0, 0, 4);
        ray.dir = random.point(-1, 1) - ray.org;
    }
    return rays;
}

/// Rays that start on every `step`th triangle, each with that triangle to skip.
struct RaysOnTriangles {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;

    RaysOnTriangles(const Soup& soup, uint32_t step) {
        Random random(6);
        for (uint32_t prim = 0; prim < soup.triangle_count(); prim += step) {
            const Triangle t = soup.triangle({0, prim});
            const double u = random(0, 0.5), v = random(0, 0.5);
            rays.push_back({t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), 0, random.point(-1, 1)});
            skip.push_back({0, prim});
        }
    }
};

/// Returns the answers that testing every triangle gives.
inline std::vector<Hit> brute_force(const Soup& soup, std::span<const Ray> rays) {
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    std::vector<Hit> hits;
    for (const Ray& ray : rays)
        hits.push_back(brute_force(soup, ids, ray));
    return hits;
}

/// Expects that nearest hits and occlusion equal the expected ones bit for bit.
inline void expect_answers(Structure& structure, std::span<const Ray> rays,
                           std::span<const Hit> expected) {
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> shadows(rays.size());
    const Result<Done> found = structure.intersect(rays, {}, hits);
    ASSERT_TRUE(found) << found.error().message;
    const Result<Done> asked = structure.occluded(rays, {}, shadows);
    ASSERT_TRUE(asked) << asked.error().message;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(expected[i], hits[i]))
            << "ray " << i << ": " << describe(expected[i]) << " but found " << describe(hits[i]);
        ASSERT_EQ(expected[i].is_hit(), shadows[i] != 0) << "ray " << i;
    }
}

/// Expects the counts of a structure after one call of expect_answers() with these rays.
inline void expect_counts(const ovc_statistics& s, std::span<const Ray> rays) {
    EXPECT_EQ(s.nearest_rays, rays.size());
    EXPECT_EQ(s.occlusion_rays, rays.size());
    EXPECT_EQ(s.invalid_rays, 2 * size_t(std::count_if(rays.begin(), rays.end(),
                                                       [](auto& r) { return !r.valid(); })));
    EXPECT_LE(s.gpu_peak_bytes, s.gpu_budget_bytes);
}

/// Pushes rays a few at a time when asked, and for every hit an occlusion ray from there; keeps all
/// answers by token.
class Spawner final : public StreamHost {
public:
    Spawner(std::span<const Ray> rays, size_t at_once)
        : hits_of(rays.size()), blocked(rays.size(), 2), rays_(rays), at_once_(at_once) {}

    bool more(RayStream& stream, size_t) override {
        const size_t count = std::min(at_once_, rays_.size() - next_);
        std::vector<uint64_t> tokens(count);
        std::iota(tokens.begin(), tokens.end(), next_);
        stream.push({false, rays_.subspan(next_, count), {}, tokens, {}, {}, filters});
        next_ += count;
        return true;
    }
    bool hits(RayStream& stream, std::span<const uint64_t> tokens,
              std::span<const Hit> hits) override {
        std::vector<Ray> spawned;
        std::vector<TriangleId> skip;
        std::vector<uint64_t> names;
        for (size_t i = 0; i < tokens.size(); ++i) {
            ++answers;
            hits_of[tokens[i]] = hits[i];
            if (!hits[i].is_hit())
                continue;
            spawned.push_back(from_hit(rays_[tokens[i]], hits[i]));
            skip.push_back(hits[i].id);
            names.push_back(tokens[i]);
        }
        stream.push({true, spawned, skip, names, {}, {}, filters});
        return answers < stop_after;
    }
    bool occlusions(RayStream&, std::span<const uint64_t> tokens,
                    std::span<const uint8_t> occluded) override {
        for (size_t i = 0; i < tokens.size(); ++i)
            blocked[tokens[i]] = occluded[i];
        return true;
    }

    static Ray from_hit(const Ray& ray, const Hit& hit) {
        return {ray.at(hit.t), 0, dvec3(0.3, 1, -0.2)};
    }

    std::vector<Hit> hits_of;
    std::vector<uint8_t> blocked; // 2: never asked
    size_t answers = 0;
    size_t stop_after = ~size_t(0);
    std::span<HitFilter* const> filters{}; // empty, or one for all rays

private:
    std::span<const Ray> rays_;
    size_t at_once_;
    size_t next_ = 0;
};

} // namespace ovc::test
