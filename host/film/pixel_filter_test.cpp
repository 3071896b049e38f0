// SPDX-License-Identifier: Apache-2.0
// Tests that samples lie as densely as their filter's formula says.
#include "host/film/pixel_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace ovc {
namespace {

using Kind = FilterOptions::Kind;

/// Returns the share of the filter from -1 to `to`, by Simpson's rule.
double share_before(Kind kind, double to) {
    const auto integral = [&](double end) {
        constexpr int kParts = 2000;
        double sum = 0;
        for (int i = 0; i <= kParts; ++i)
            sum += (i == 0 || i == kParts ? 1
                    : i % 2               ? 4
                                          : 2) *
                   filter_weight(kind, -1 + (end + 1) * i / kParts);
        return sum * (end + 1);
    };
    return integral(to) / integral(1);
}

TEST(PixelFilter, ABoxLeavesPlacesAsTheyAre) {
    const PixelFilter filter;
    for (const dvec2 u : {dvec2(0), dvec2(0.1, 0.7), dvec2(0.3, 0x1p-30)})
        EXPECT_EQ(filter.place(u), u);
    const dvec2 wide = PixelFilter({Kind::Flat, 1.5}).place({0, 0.75});
    EXPECT_DOUBLE_EQ(wide.x, -1);
    EXPECT_DOUBLE_EQ(wide.y, 1.25);
}

TEST(PixelFilter, PlacesInvertTheFiltersRunningSum) {
    for (const Kind kind : {Kind::Gaussian, Kind::BlackmanHarris}) {
        const PixelFilter filter({kind, 1.5});
        EXPECT_EQ(filter.place(dvec2(0.5)), dvec2(0.5));
        double before = -1;
        for (double u = 0; u < 1; u += 1.0 / 128) {
            const double x = filter.place({u, 0.5}).x;
            EXPECT_GE(x, before);
            before = x;
            EXPECT_NEAR(share_before(kind, (x - 0.5) / 1.5), u, 1e-4) << int(kind) << " at " << u;
        }
        EXPECT_NEAR(filter.place(dvec2(0)).y, -1, 1e-12);
        EXPECT_NEAR(filter.place(dvec2(1 - 0x1p-53)).y, 2, 1e-2);
    }
}

/// The windows' ends and middles are known: Harris 1978, table 1, sums the four terms to 6.0e-5.
TEST(PixelFilter, WeightsAreThoseOfTheFormulas) {
    EXPECT_DOUBLE_EQ(filter_weight(Kind::BlackmanHarris, 0), 1);
    EXPECT_NEAR(filter_weight(Kind::BlackmanHarris, 1), 6.0e-5, 1e-9);
    EXPECT_NEAR(filter_weight(Kind::Gaussian, 1), 0, 1e-15);
    EXPECT_DOUBLE_EQ(filter_weight(Kind::Gaussian, 0), 1);
    EXPECT_NEAR(filter_weight(Kind::Gaussian, 1.0 / 3), 0.6021105,
                1e-6); // e^-1/2, lowered by e^-9/2
    EXPECT_EQ(filter_weight(Kind::Flat, 1.01), 0);
}

} // namespace
} // namespace ovc
