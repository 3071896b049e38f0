// SPDX-License-Identifier: Apache-2.0
// Tests curves of tone mapping against values of their formulas, which another program computed,
// and exposures against pictures whose average is known.
#include "host/output/tone_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ovc {
namespace {

TEST(ToneMapping, CurvesHaveTheValuesOfTheirFormulas) {
    struct Known {
        float light, filmic, aces;
    };
    for (const Known& known : {Known{0, 0, 0}, Known{0.18f, 0.1283384f, 0.2668989f},
                               Known{1, 0.4929185f, 0.8037975f}, Known{5.6f, 1, 0.9903677f}}) {
        EXPECT_NEAR(tone_mapped(known.light, ToneMap::Filmic), known.filmic, 2e-6) << known.light;
        EXPECT_NEAR(tone_mapped(known.light, ToneMap::Aces), known.aces, 2e-6) << known.light;
        EXPECT_EQ(tone_mapped(known.light, ToneMap::None), known.light);
    }
}

TEST(ToneMapping, CurvesRiseAndStayWithinADisplaysRange) {
    for (const ToneMap curve : {ToneMap::Filmic, ToneMap::Aces}) {
        float before = 0;
        for (float light = 1e-4f; light < 1e30f; light *= 1.3f) {
            const float tone = tone_mapped(light, curve);
            EXPECT_GE(tone, before);
            EXPECT_LE(tone, 1);
            before = tone;
        }
        EXPECT_FLOAT_EQ(before, 1);
        EXPECT_EQ(tone_mapped(-1, curve), 0);
        EXPECT_EQ(tone_mapped(std::numeric_limits<float>::quiet_NaN(), curve), 0);
    }
}

TEST(ToneMapping, AStopDoublesLightAndLeavesAlpha) {
    Image image(1, 1);
    image.pixels[0] = {0.1f, 0.2f, 3, 0.5f};
    expose(image.pixels, 1);
    EXPECT_EQ(image.pixels[0], vec4(0.2f, 0.4f, 6, 0.5f));
    expose(image.pixels, -3);
    EXPECT_EQ(image.pixels[0], vec4(0.025f, 0.05f, 0.75f, 0.5f));
}

TEST(ToneMapping, AutomaticExposureMakesTheAverageMiddleGrey) {
    Image image(3, 1);
    EXPECT_EQ(automatic_stops(image), 0); // all black
    image.pixels = {vec4(vec3(0.09f), 1), vec4(vec3(0.36f), 1), vec4(0)};
    EXPECT_NEAR(automatic_stops(image), 0, 1e-6); // the geometric mean is 0.18; black counts not
    for (vec4& pixel : image.pixels)
        pixel *= 0.25f;
    EXPECT_NEAR(automatic_stops(image), 2, 1e-6);
}

} // namespace
} // namespace ovc
