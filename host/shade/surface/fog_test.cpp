// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/fog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

/// The fog of `fog { distance 20 rgb 1 turbulence T turb_depth D }` before a black wall 10 away, as
/// povray 3.7.0.10 draws it, has these optical depths, in units of those without turbulence.
TEST(Fog, IsThinnedByTurbulenceAsPovrayDoes) {
    const struct {
        double turbulence, depth;
        dvec2 at;
        double expected;
    } kCases[] = {{1, 0.5, {0, 0}, 0.82425},
                  {1, 0.5, {1.3, 4.1}, 0.54096},
                  {0.5, 0.5, {-2.2, 0.7}, 0.76701},
                  {1, 1, {3, 0}, 0.39347},
                  {1, 0.01, {3, 0}, 0.99046}};
    for (const auto& test : kCases) {
        const Ray ray{dvec3(test.at, -10), 0, dvec3(0, 0, 1), 1e30};
        Fog fog{.color = {vec3(1)}, .distance = 20};
        fog.turbulence = dvec3(test.turbulence), fog.turbulence_depth = test.depth;
        const ThroughFog through = through_fog({&fog, 1}, ray, 10);
        EXPECT_NEAR(-2 * std::log(double(through.share.x)), test.expected, 1e-3)
            << test.at.x << " " << test.at.y;
    }
    Fog ground{.color = {vec3(1)}, .distance = 20, .altitude = 0.5};
    ground.turbulence = dvec3(1);
    const Ray ray{dvec3(0.5, 0.3, -10), 0, dvec3(0, 0, 1), 1e30};
    const ThroughFog through = through_fog({&ground, 1}, ray, 10);
    EXPECT_NEAR(-2 * std::log(double(through.share.x)), 0.44133, 1e-3);
}

/// povray 3.7.0.10 draws these with a background of <0.2, 0.4, 0.8>.
TEST(Fog, RainbowsLieAroundSunlightAsPovrayDrawsThem) {
    const vec3 sky(0.2f, 0.4f, 0.8f);
    const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
    const auto seen = [&](const Rainbow& bow, double x, double y, double t) {
        const ThroughFog through =
            through_rainbows({&bow, 1}, {dvec3(0), 0, dvec3(x, y, 1), 1e30}, t);
        return through.share * sky + through.added;
    };
    const auto expect = [](const vec3& found, const vec3& expected) {
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(found[i], expected[i], 2e-3) << i;
    };
    Rainbow bow{.angle = 25, .width = 20, .distance = 3e7};
    bow.colors = {{0, {vec3(1, 0, 0)}}, {1, {vec3(0, 0, 1)}}};
    const double x = std::tan(radians(21.32)); // 0.316 of the width
    expect(seen(bow, x, 0, INFINITY), {0.684f, 0, 0.316f});
    expect(seen(bow, 0.05, 0.05, INFINITY), sky);
    expect(seen(bow, 0.9, 0, INFINITY), sky);
    bow.colors[0].color.transmit = bow.colors[1].color.transmit = 0.3f;
    expect(seen(bow, x, 0, INFINITY), {0.5389f, 0.12f, 0.4611f});
    bow.colors[0].color.transmit = bow.colors[1].color.transmit = 0;
    bow.arc = 90, bow.full_arc = 45, bow.up = dvec3(1, 0, 0);
    const auto around = [&](double degrees) {
        const double turn = radians(degrees), wide = std::tan(radians(28));
        return seen(bow, wide * std::cos(turn), wide * std::sin(turn), INFINITY).y;
    };
    EXPECT_NEAR(around(26.6), 0.0345, 1e-3);
    EXPECT_NEAR(around(-36), 0.26, 1e-3);
    EXPECT_NEAR(around(50.7), 0.4, 1e-6);
    bow.distance = 8;
    const float hidden = 1 - std::exp(-1.0f);
    EXPECT_NEAR(seen(bow, x, 0, 8 / std::hypot(1, x)).x, hidden * 0.684f + (1 - hidden) * 0.2f,
                1e-3);
}

/// povray 3.7.0.10 draws a wall of green light of 0.9, 5 away in two fogs, at 175 and 183.5 of 255.
TEST(Fog, SeveralAddUpAsPovrayDoes) {
    const Ray ray{dvec3(0), 0, dvec3(0, 0, 1), 1e30};
    Fog fogs[] = {{{vec3(0.5f, 0.1f, 0.1f)}, 5}, {{vec3(0, 0.4f, 0.9f)}, 8}};
    const auto green = [&] {
        const ThroughFog through = through_fog(fogs, ray, 5);
        return through.share.y * 0.9f + through.added.y;
    };
    EXPECT_NEAR(green(), 0.4264, 1e-3);
    fogs[0].color.transmit = 0.5f;
    EXPECT_NEAR(green(), 0.4768, 1e-3);
}

TEST(Fog, HidesTheSky) {
    const Fog fog{{vec3(0.5f)}, 5};
    const ThroughFog seen = through_fog({&fog, 1}, {dvec3(0), 0, dvec3(0, 0, 1), 1e30}, INFINITY);
    EXPECT_EQ(seen.share, vec3(0));
    EXPECT_EQ(seen.added, vec3(0.5f));
}

} // namespace ovc
