// SPDX-License-Identifier: Apache-2.0
// Tests that a tie is no error, and that what looks like one may be an error.
#include "host/suites/judge.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Two triangles that share a side, the first once more, and one just behind it.
Soup example() {
    const vec3 a(0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0), behind(0, 0, 1e-6f);
    Soup soup;
    soup.chunks.push_back(
        Chunk::owning(dvec3(0), {a, b, c, b, d, c, a, b, c, a + behind, b + behind, c + behind}));
    return soup;
}

Ray down_to(double x, double y) {
    return {dvec3(x, y, -1), 0, dvec3(0, 0, 1)};
}

TEST(Judge, CallsAnotherTriangleAtTheSameTATie) {
    const std::vector<Ray> rays = {down_to(0.5, 0.5), down_to(0.25, 0.25)};
    const std::vector<double> t = {1, 1};
    const NamedHits right = {{{0, 0}, {0, 0}}, t};
    const Verdicts verdicts = judge(example(), rays, {{{0, 1}, {0, 2}}, t}, right);
    EXPECT_EQ(verdicts.tied, 2u); // the shared side, and the duplicate
    EXPECT_EQ(verdicts.wrong, 0u);
    EXPECT_EQ(verdicts.leaked, 0u);
    EXPECT_EQ(judge(example(), rays, right, right).tied, 0u);
}

TEST(Judge, CallsATriangleThatTheRayMissesOrMeetsLaterWrong) {
    // The first ray passes 2^-40 beside the shared side; the second meets triangle 3 later.
    const std::vector<Ray> rays = {down_to(0.5 - 0x1p-40, 0.5), down_to(0.25, 0.25),
                                   down_to(0.25, 0.25), down_to(5, 5)};
    const std::vector<double> t = {1, 1, 1, 1}, said = {1 + 0x1p-22, 1 + 1e-6, 1, 1};
    const NamedHits right = {{{0, 0}, {0, 0}, {0, 0}, {}}, t};
    const Verdicts verdicts =
        judge(example(), rays, {{{0, 1}, {0, 3}, {7, 9}, {0, 0}}, said}, right);
    EXPECT_EQ(verdicts.wrong, 4u);
    EXPECT_EQ(verdicts.beside, 1u) << "two units of the last place off";
    EXPECT_EQ(verdicts.tied, 0u);
}

TEST(Judge, CountsMissesOfWhatIsHit) {
    const std::vector<Ray> rays = {down_to(0.25, 0.25), down_to(5, 5)};
    const std::vector<double> t = {1, 1};
    const Verdicts verdicts = judge(example(), rays, {{{}, {}}, t}, {{{0, 0}, {}}, t});
    EXPECT_EQ(verdicts.leaked, 1u);
    EXPECT_EQ(verdicts.wrong + verdicts.tied, 0u);
    const std::vector<uint8_t> seen = {1, 0, 1}, told = {0, 1, 1};
    EXPECT_EQ(judge(told, seen).leaked, 1u);
    EXPECT_EQ(judge(told, seen).wrong, 1u);
}

} // namespace
} // namespace ovc
