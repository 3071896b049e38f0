// SPDX-License-Identifier: Apache-2.0
// Pairs that are tested together get the answers that each gets by itself.
#include "core/lanes/doubt_batch.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace ovc {
namespace {

class UnitRandom {
public:
    explicit UnitRandom(uint64_t seed) : engine_(seed) {}
    double operator()() { return unit_(engine_); }
    dvec3 point() { return {(*this)(), (*this)(), (*this)()}; }

private:
    std::mt19937_64 engine_;
    std::uniform_real_distribution<double> unit_{-1, 1};
};

/// Returns seven triangles round one corner.
std::vector<Triangle> random_fan(UnitRandom& random) {
    const dvec3 hub = random.point();
    std::vector<dvec3> rim;
    for (int i = 0; i < 7; ++i)
        rim.push_back(hub + 0.01 * random.point());
    std::vector<Triangle> triangles;
    for (size_t i = 0; i < rim.size(); ++i)
        triangles.push_back({hub, rim[i], rim[(i + 1) % rim.size()]});
    return triangles;
}

TEST(DoubtBatch, AnswersAsForEachPairAlone) {
    size_t hits = 0, misses = 0;
    for (uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        UnitRandom random(seed);
        const std::vector<Triangle> triangles = random_fan(random);
        Ray ray{5.0 * random.point(), 0, dvec3(0), 1 + 1e-9 * random()};
        const Triangle& aim = triangles[0];
        const dvec3 target = seed % 2 ? aim[0] : glm::mix(aim[0], aim[1], 0.5 + 0.5 * random());
        ray.dir = target - ray.org;
        const PreparedRay p(ray);
        DoubtBatch<size_t> batch;
        ASSERT_GE(batch.room(), int(triangles.size()));
        for (size_t i = 0; i < triangles.size(); ++i)
            batch.add(&ray, triangles[i], {0, uint32_t(i)}, 10 * i);
        size_t next = 0;
        batch.finish([&](const RefinedAnswer& answer, const Triangle& triangle, TriangleId id,
                         size_t tag) {
            ASSERT_EQ(tag, 10 * next);
            ASSERT_EQ(id, (TriangleId{0, uint32_t(next)}));
            ASSERT_EQ(triangle, triangles[next++]);
            if (!answer.known)
                return;
            std::optional<Candidate> alone = candidate(p, triangle, id);
            ASSERT_EQ(answer.candidate.has_value(), alone.has_value()) << "triangle " << id.prim;
            (alone ? hits : misses) += 1;
            if (alone) {
                EXPECT_EQ(answer.candidate->compare_t(*alone), 0);
            }
        });
        EXPECT_EQ(next, triangles.size());
        EXPECT_TRUE(batch.empty());
    }
    EXPECT_GT(hits, 200u);
    EXPECT_GT(misses, 1000u);
}

} // namespace
} // namespace ovc
