// SPDX-License-Identifier: Apache-2.0
// Inverses of transforms: those that doubles can tell are right, and others are refused.
#include "core/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ovc {
namespace {

// The second and the third row are multiples of the first, rounded: the determinant is nothing but
// roundings, and by chance as large as if the matrix could be inverted.
TEST(Transform, HasNoInverseWhereItIsSingularButForRoundings) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const double size = std::exp2(30 * any(random));
        const double first[3] = {size * any(random), size * any(random), size * any(random)};
        Transform transform{};
        for (auto& row : transform.rows) {
            const double share = any(random);
            row = {share * first[0], share * first[1], share * first[2], any(random)};
        }
        EXPECT_FALSE(inverse_matrix(transform));
        EXPECT_FALSE(is_well_placed({dvec3(-1), dvec3(1)}, &transform));
    }
}

TEST(Transform, GoesBackToWhereItCameFrom) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-1, 1);
    int placed = 0;
    for (int i = 0; i < 1000; ++i) {
        Transform transform{};
        for (auto& row : transform.rows)
            row = {any(random), any(random), any(random), 100 * any(random)};
        if (!is_well_placed({dvec3(-1), dvec3(1)}, &transform))
            continue;
        ++placed;
        const dvec3 point(any(random), any(random), any(random));
        const dvec3 back = (*inverse(transform))(transform(point));
        EXPECT_LT(glm::length(back - point), 0x1p-30);
    }
    EXPECT_GT(placed, 950);
}

} // namespace
} // namespace ovc
