// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/bounced_light.h"

#include <gtest/gtest.h>

namespace ovc {

/// Returns a floor at y = 0 whose light is x, and a wall at x = 0 whose light is 5.
static std::vector<BouncedLight::Record> corner_of_a_room() {
    std::vector<BouncedLight::Record> records;
    for (int i = 0; i <= 40; ++i)
        for (int j = -20; j <= 20; ++j) {
            records.push_back({{0.1 * i, 0, 0.1 * j}, {0, 1, 0}, vec3(0.1f * float(i))});
            records.push_back({{0, 0.1 * i, 0.1 * j}, {1, 0, 0}, vec3(5)});
        }
    return records;
}

TEST(BouncedLight, IsTheMeanOfNearRecordsThatFaceTheSameWay) {
    const BouncedLight light(corner_of_a_room());
    for (const double x : {0.5, 1.23, 3.3})
        EXPECT_NEAR(light.at({x, 0, 0.17}, {0, 1, 0}).x, x, 0.05);
    EXPECT_NEAR(light.at({0.01, 0.02, 0}, {1, 0, 0}).x, 5, 1e-6) << "the wall alone";
    EXPECT_LT(light.at({0.02, 0.01, 0}, {0, 1, 0}).x, 0.3) << "the floor alone";
}

TEST(BouncedLight, IsTheMeanOfAllWhereNoneFacesThatWay) {
    const BouncedLight light(corner_of_a_room());
    EXPECT_NEAR(light.at({1, 0, 0}, {0, -1, 0}).x, 0.5 * (5 + 2), 1e-3);
    EXPECT_EQ(BouncedLight({}).at({1, 0, 0}, {0, -1, 0}), vec3(0));
}

} // namespace ovc
