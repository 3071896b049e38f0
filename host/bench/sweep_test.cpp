// SPDX-License-Identifier: Apache-2.0
// Tests the exponent that a sweep's table ends with.
#include "host/bench/sweep.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace ovc {
namespace {

Sweep example_sweep() {
    Sweep sweep{"knot", "rays", {"linear", "root", "unmeasured", "once"}, {}, true};
    for (const double x : {1e3, 1e4, 1e5, 1e7})
        sweep.rows.push_back({x, {3e-7 * x, 0.2 * std::sqrt(x), {}, {}}});
    sweep.rows[1].values[3] = 1;
    return sweep;
}

TEST(Sweep, FitsThePowerLaw) {
    EXPECT_NEAR(*fitted_exponent(example_sweep(), 0), 1, 1e-12);
    EXPECT_NEAR(*fitted_exponent(example_sweep(), 1), 0.5, 1e-12);
    EXPECT_FALSE(fitted_exponent(example_sweep(), 2));
    EXPECT_FALSE(fitted_exponent(example_sweep(), 3));
}

TEST(Sweep, FitsTheNearestWhereNoneFits) {
    Sweep sweep{
        "", "", {"y"}, {{1, {1.0}}, {std::exp(1), {1.0}}, {std::exp(2), {std::exp(1)}}}, true};
    EXPECT_NEAR(*fitted_exponent(sweep, 0), 0.5, 1e-12); // by hand: points (0,0), (1,0), (2,1)
}

TEST(Sweep, IsATableAndJson) {
    const std::string table = sweep_table(example_sweep());
    EXPECT_THAT(table, testing::HasSubstr("10,000,000"));
    EXPECT_THAT(table, testing::ContainsRegex("exponent +\\| +1.00 \\| +0.50 \\| +- \\|"));
    const auto document = nlohmann::json::parse(sweep_json(example_sweep()));
    EXPECT_EQ(document["rows"].size(), 4u);
    EXPECT_EQ(document["rows"][0]["values"][2], nullptr);
    EXPECT_NEAR(document["exponents"][0], 1, 1e-12);
    EXPECT_EQ(document["columns"].size(), 4u);
}

} // namespace
} // namespace ovc
