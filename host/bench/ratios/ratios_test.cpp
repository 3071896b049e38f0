// SPDX-License-Identifier: Apache-2.0
// Tests medians, rates, and which of two times is divided by which.
#include "host/bench/ratios/ratios.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

Contender named(std::string_view name) {
    const std::vector<std::string> only{std::string(name)};
    return choose_contenders(only, std::vector<LeavesChoice>(1), std::vector<BudgetChoice>(1),
                             std::vector<InstancesChoice>(1))
        ->front();
}

class BenchRatios : public testing::Test {
protected:
    const Measurement& add(Contender contender, double call, double kernel) {
        result.entrants.push_back({contender, "", {}, {}});
        Measurement m;
        m.entrant = result.entrants.size() - 1;
        m.rays = 1'000'000;
        m.seconds = {call, call, 100};
        m.cpu_seconds = {3 * call, 3 * call, 100};
        m.kernel_seconds = {kernel, kernel, 100};
        result.measurements.push_back(m);
        return result.measurements.back();
    }
    BenchRatios() { result.measurements.reserve(10); }

    BenchResult result;
};

TEST(Spread, IsMinMedianMax) {
    const Spread odd = spread_of(std::vector<double>{3, 1, 7});
    EXPECT_EQ(odd.min, 1);
    EXPECT_EQ(odd.median, 3);
    EXPECT_EQ(odd.max, 7);
    EXPECT_EQ(spread_of(std::vector<double>{4, 1, 2, 9}).median, 3);
    EXPECT_EQ(spread_of(std::vector<double>{5}).median, 5);
}

TEST_F(BenchRatios, TakeTheCallOfAPeerThatKnowsNoKernel) {
    const Measurement& certified = add(named("certified-compute"), 0.5, 0.25);
    add(named("cpu-float-kdtree"), 2, 0);
    add(named("embree-high"), 1, 0.125);
    EXPECT_DOUBLE_EQ(*kernel_speed_to(result, certified, "cpu-float-kdtree"), 8);
    EXPECT_DOUBLE_EQ(*kernel_speed_to(result, certified, "embree-high"), 0.5);
    EXPECT_FALSE(kernel_speed_to(result, certified, "embree-robust"));
}

TEST_F(BenchRatios, SayHowMuchFasterThanEmbreeAndHowMuchSlowerThanFast) {
    const Measurement& certified = add(named("certified-compute"), 0.5, 0.25);
    const Measurement& fast = add(named("fast-compute"), 0.4, 0.2);
    add(named("fast-fragment"), 0.1, 0.1); // another kernel
    const Measurement& robust = add(named("embree-robust"), 1, 0);
    const Ratios r = ratios_of(result, certified);
    EXPECT_DOUBLE_EQ(*r.call_speed_to_robust, 2);
    EXPECT_DOUBLE_EQ(*r.kernel_speed_to_robust, 4);
    EXPECT_DOUBLE_EQ(*r.cpu_speed_to_robust, 2);
    EXPECT_DOUBLE_EQ(*r.call_time_to_fast, 1.25);
    EXPECT_DOUBLE_EQ(*r.cpu_time_to_fast, 1.25);
    EXPECT_DOUBLE_EQ(*r.kernel_time_to_fast, 1.25);
    EXPECT_DOUBLE_EQ(*ratios_of(result, fast).call_time_to_fast, 1);
    EXPECT_DOUBLE_EQ(*ratios_of(result, robust).call_speed_to_robust, 1);
    EXPECT_DOUBLE_EQ(*ratios_of(result, robust).kernel_speed_to_robust, 1);
    EXPECT_FALSE(ratios_of(result, robust).call_time_to_fast);
    EXPECT_DOUBLE_EQ(*mrays(certified, 0.5), 2);
    EXPECT_FALSE(mrays(robust, 0));
}

TEST_F(BenchRatios, CompareASweepWithItsFirstValue) {
    Contender eight = named("certified-compute"), many = eight;
    eight.leaves = {8, "8"};
    many.leaves = {128, "128"};
    add(eight, 0.2, 0.1);
    const Measurement& last = add(many, 0.3, 0.2);
    Contender fast = named("fast-compute");
    fast.leaves = {8, "8"};
    add(fast, 0.1, 0.1);
    const Ratios r = ratios_of(result, last);
    EXPECT_DOUBLE_EQ(*r.call_time_to_first, 1.5);
    EXPECT_DOUBLE_EQ(*r.kernel_time_to_first, 2);
    EXPECT_FALSE(r.call_time_to_fast); // fast ran with 8 leaves only
    EXPECT_FALSE(r.call_speed_to_robust);
}

TEST_F(BenchRatios, StayWithinAWorkload) {
    const Measurement& certified = add(named("certified-compute"), 0.5, 0.25);
    add(named("embree-robust"), 1, 0);
    result.measurements[1].workload = 1;
    EXPECT_FALSE(ratios_of(result, certified).call_speed_to_robust);
}

TEST_F(BenchRatios, CompareBuildsAndSizes) {
    add(named("certified-compute"), 1, 1);
    add(named("embree-medium"), 1, 0);
    result.triangles = 100;
    result.entrants[0].built.level2_bytes = 5200;
    result.entrants[0].built.seconds_level1 = 1;
    result.entrants[0].built.seconds_level2 = 2;
    result.entrants[1].built.seconds_level2 = 1.5;
    EXPECT_DOUBLE_EQ(*build_time_to_embree(result, result.entrants[0]), 2);
    EXPECT_DOUBLE_EQ(*bytes_a_triangle(result, result.entrants[0]), 52);
    EXPECT_FALSE(bytes_a_triangle(result, result.entrants[1]));
}

} // namespace
} // namespace ovc
