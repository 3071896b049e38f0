// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/fog.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

/// povray 3.7.0.10 draws these at the corner of a picture of a wall 3 away, with ambient light of
/// <0.8, 0.6, 0.4>.
TEST(Fog, MixesColorsAsPovrayDoes) {
    const vec3 wall(0.8f, 0.6f, 0.4f);
    // The ray's direction through the middle of the upper left pixel of 2 x 2.
    const Ray ray{dvec3(0, 1, 0), 0, dvec3(-0.3325, 0.25, 1), 1e30};
    const struct {
        Fog fog;
        vec3 expected;
    } kCases[] = {
        {{{vec3(0.5f, 0.3f, 0.1f)}, 5}, {0.65664f, 0.45664f, 0.25664f}},
        {{{vec3(0.5f, 0.3f, 0.1f), 0, 0.7f}, 5}, {0.71000f, 0.51000f, 0.31000f}},
        {{{vec3(0.5f, 0.3f, 0.1f), 0.5f, 0}, 5}, {0.55221f, 0.34699f, 0.16266f}},
        {{{vec3(0.5f, 0.3f, 0.1f), 0.3f, 0.2f}, 1}, {0.53600f, 0.33480f, 0.13840f}},
        {{{vec3(0.5f)}, 5, 2, 0.5}, {0.67422f, 0.55807f, 0.44193f}},
        {{{vec3(0.5f)}, 5, 2, 2}, {0.65664f, 0.55221f, 0.44779f}},
    };
    for (const auto& test : kCases) {
        const ThroughFog fog = through_fog({&test.fog, 1}, ray, 3);
        const vec3 seen = fog.share * wall + fog.added;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(seen[i], test.expected[i], 1e-3) << i;
    }
}

TEST(Fog, HidesTheSky) {
    const Fog fog{{vec3(0.5f)}, 5};
    const ThroughFog seen = through_fog({&fog, 1}, {dvec3(0), 0, dvec3(0, 0, 1), 1e30}, INFINITY);
    EXPECT_EQ(seen.share, vec3(0));
    EXPECT_EQ(seen.added, vec3(0.5f));
}

} // namespace ovc
