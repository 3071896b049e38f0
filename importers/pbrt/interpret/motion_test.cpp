// SPDX-License-Identifier: Apache-2.0
#include "importers/pbrt/interpret/motion.h"

#include "importers/pbrt/interpret/transform.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc::pbrt {
namespace {

void expect_near(const dmat4& a, const dmat4& b, double error = 1e-12) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(a[column][row], b[column][row], error) << column << ", " << row;
}

TEST(Motion, BeginsAndEndsWithTheVeryMatrices) {
    const dmat4 start = rotation(17, {1, 2, 3}) * scaling({1, 2, 0.1});
    const dmat4 end = translation({0.1, 0.2, 0.3}) * rotation(55, {3, 1, 0});
    EXPECT_EQ(between(start, end, 0), start);
    EXPECT_EQ(between(start, end, 1), end);
    EXPECT_EQ(between(start, start, 0.3), start);
}

TEST(Motion, ShiftsAndScalesEvenly) {
    expect_near(between(translation({1, 2, 3}), translation({5, 2, -1}), 0.25),
                translation({2, 2, 2}));
    expect_near(between(scaling({1, 1, 1e-3}), scaling({3, 1, 3e-3}), 0.5), scaling({2, 1, 2e-3}));
    expect_near(between(scaling({-1, 1, 1}), scaling({-3, 1, 1}), 0.5), scaling({-2, 1, 1}));
}

TEST(Motion, TurnsEvenlyAndTheShortWay) {
    const dvec3 axis(1, 2, -1);
    expect_near(between(rotation(10, axis), rotation(90, axis), 0.25), rotation(30, axis));
    expect_near(between(rotation(-170, axis), rotation(170, axis), 0.5), rotation(180, axis));
    const dmat4 both = between(dmat4(1), translation({4, 0, 0}) * rotation(60, axis), 0.5);
    expect_near(both, translation({2, 0, 0}) * rotation(30, axis));
}

TEST(Motion, OfLargeAndSmallThingsIsTheSame) {
    for (const double size : {1e-12, 1e12}) {
        const dmat4 start = scaling(dvec3(size));
        const dmat4 end = rotation(80, {0, 1, 0}) * scaling(dvec3(size));
        expect_near(between(start, end, 0.5), rotation(40, {0, 1, 0}) * scaling(dvec3(size)),
                    1e-9 * size);
    }
}

TEST(Motion, OfWhatIsFlatGoesOnNumberByNumber) {
    const dmat4 flat = scaling({1, 0, 1});
    expect_near(between(flat, scaling({1, 2, 1}), 0.5), scaling({1, 1, 1}));
    dmat4 projects(1);
    projects[0].w = 0.5;
    EXPECT_EQ(between(dmat4(1), projects, 0.5)[0].w, 0.25);
}

} // namespace
} // namespace ovc::pbrt
