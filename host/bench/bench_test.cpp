// SPDX-License-Identifier: Apache-2.0
// Tests turns, counts of differing answers and stopping, with backends whose answers are scripted.
#include "host/bench/bench.h"

#include "core/system/parallel.h"
#include "host/terminal/process_cost.h"

#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

namespace ovc {
namespace {

/// Hits triangle (0, prim) with every ray, and counts two passes a call.
class Scripted final : public Backend {
public:
    Scripted(std::string name, uint32_t prim, std::vector<std::string>& calls)
        : name_(std::move(name)), prim_(prim), calls_(calls) {}

    Result<Done> intersect(std::span<const Ray>, const Exclusions&, std::span<Hit> hits) override {
        calls_.push_back(name_);
        for (Hit& hit : hits)
            hit = {1, 0, 0, {0, prim_}};
        statistics_.passes += 2;
        statistics_.flagged += hits.size();
        statistics_.seconds_pass += 0.5;
        statistics_.seconds_kernel += 0.25;
        return Done{};
    }
    Result<Done> occluded(std::span<const Ray>, const Exclusions&, std::span<uint8_t>) override {
        return Error{name_ + " does not do that"};
    }
    ovc_statistics statistics() const override { return statistics_; }
    std::string renderer() const override { return "scripted " + name_; }

private:
    std::string name_;
    uint32_t prim_;
    std::vector<std::string>& calls_;
    ovc_statistics statistics_{};
};

class RunContenders : public testing::Test {
protected:
    void enter(const char* name, uint32_t prim) {
        Contender contender{};
        contender.name = name;
        entrants.push_back({contender, std::make_unique<Scripted>(name, prim, calls)});
    }
    Result<Done> run(
        uint32_t repeats, const StopRequest& stop = [] { return false; }) {
        return run_contenders(
            entrants, workloads, soup, reference, repeats, stop, [](const std::string&) {}, result);
    }

    Soup soup;
    std::vector<std::string> calls;
    Scripted reference{"reference", 7, calls};
    std::vector<Entrant> entrants;
    std::vector<Workload> workloads;
    BenchResult result;
};

TEST_F(RunContenders, TakeTurns) {
    enter("a", 7);
    enter("b", 7);
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(3)}));
    ASSERT_TRUE(run(2));
    EXPECT_THAT(calls, testing::ElementsAre("reference", "a", "b", "a", "b", "a", "b"));
    EXPECT_TRUE(result.complete);
    ASSERT_EQ(result.measurements.size(), 2u);
    for (const Measurement& m : result.measurements) {
        EXPECT_EQ(m.rays, 3u);
        EXPECT_EQ(m.seconds.size(), 2u);
        EXPECT_EQ(m.cpu_seconds.size(), 2u);
        EXPECT_THAT(m.pass_seconds, testing::ElementsAre(0.5, 0.5));
        EXPECT_THAT(m.kernel_seconds, testing::ElementsAre(0.25, 0.25));
        EXPECT_EQ(m.passes, 2u); // those of one call, not the sum
        EXPECT_EQ(m.flagged, 3u);
    }
    EXPECT_EQ(result.entrants[1].renderer, "scripted b");
}

/// Works for 20 ms on a CPU and sleeps for 200 ms, as if other programs had taken the CPU.
class Interrupted final : public Backend {
public:
    Result<Done> intersect(std::span<const Ray>, const Exclusions&, std::span<Hit>) override {
        const double begin = process_cpu_seconds();
        while (process_cpu_seconds() < begin + 0.02) {
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return Done{};
    }
    Result<Done> occluded(std::span<const Ray>, const Exclusions&, std::span<uint8_t>) override {
        return Done{};
    }
    ovc_statistics statistics() const override { return {}; }
    std::string renderer() const override { return "interrupted"; }
};

/// Names the same triangle of a certain mesh for every ray.
template <uint32_t kMesh>
class CopyNamed final : public Backend {
public:
    Result<Done> intersect(std::span<const Ray>, const Exclusions&, std::span<Hit> hits) override {
        for (Hit& hit : hits)
            hit = {1, 0.25, 0.25, {kMesh, 0}};
        return Done{};
    }
    Result<Done> occluded(std::span<const Ray>, const Exclusions&, std::span<uint8_t>) override {
        return Done{};
    }
    ovc_statistics statistics() const override { return {}; }
    std::string renderer() const override { return "a copy"; }
};
using FirstCopy = CopyNamed<0>;
using OtherCopy = CopyNamed<8>;

TEST_F(RunContenders, AskSmallCallsForAllRays) {
    enter("one", 0);
    RaySet set{"primary", RayQuery::Nearest, std::vector<Ray>(2 * kSmallCallRays + 1)};
    workloads = {ray_workload(set), in_small_calls(ray_workload(set))};
    EXPECT_EQ(workloads[1].name, "primary-small");
    const auto calls_for = [&](Workload& workload) {
        calls.clear();
        const Result<uint64_t> rays = workload.run(*entrants[0].backend);
        EXPECT_TRUE(rays && *rays == set.rays.size());
        return calls.size();
    };
    EXPECT_EQ(calls_for(workloads[0]), 1u);
    EXPECT_EQ(calls_for(workloads[1]), 3u);
    EXPECT_EQ(workloads[1].answers(), workloads[0].answers());
}

TEST_F(RunContenders, OnTheCpuAreTimedByWhatAThreadTook) {
    entrants.push_back({Contender{}, std::make_unique<Interrupted>()});
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(3)}));
    ASSERT_TRUE(run(1));
    ASSERT_EQ(result.measurements.size(), 1u);
    const Measurement& m = result.measurements[0];
    EXPECT_GE(m.seconds[0], 0.22);
    EXPECT_DOUBLE_EQ(m.kernel_seconds[0], m.cpu_seconds[0] / double(thread_count()));
    EXPECT_GE(m.cpu_seconds[0], 0.02);
}

TEST_F(RunContenders, CountAnswersUnlikeTheReferences) {
    enter("right", 7);
    enter("wrong", 8);
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(5)}));
    ASSERT_TRUE(run(1));
    EXPECT_EQ(result.measurements[0].differing, 0u);
    EXPECT_EQ(result.measurements[1].differing, 5u);
    EXPECT_NE(result.measurements[0].checksum, result.measurements[1].checksum);
    EXPECT_EQ(result.measurements[0].checksum, checksum(std::vector<uint64_t>(5, 7)));
    // Only certified answers are promised to be right.
    result.entrants[1].contender.kind = ContenderKind::Embree;
    EXPECT_EQ(wrong_answers(result), "");
    result.entrants[1].contender.kind = ContenderKind::TwoLevel;
    EXPECT_THAT(wrong_answers(result), testing::HasSubstr("5 answers unlike"));
    result.entrants[1].contender.precision = OVC_PRECISION_FAST;
    EXPECT_EQ(wrong_answers(result), "");
}

/// A peer that breaks ties otherwise is not charged with a wrong answer.
TEST_F(RunContenders, CountTiesApartFromWrongAnswers) {
    const std::vector<vec3> triangle = {{-1, -1, 1}, {3, -1, 1}, {-1, 3, 1}};
    for (int copy = 0; copy < 9; ++copy)
        soup.chunks.push_back(Chunk::owning(dvec3(0), triangle));
    entrants.push_back({Contender{}, std::make_unique<OtherCopy>()});
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(5)}));
    FirstCopy first;
    ASSERT_TRUE(run_contenders(
        entrants, workloads, soup, first, 1, [] { return false; }, [](const std::string&) {},
        result));
    EXPECT_EQ(result.measurements[0].differing, 5u);
    EXPECT_EQ(result.measurements[0].verdicts.tied, 5u);
    EXPECT_EQ(result.measurements[0].verdicts.wrong, 0u);
}

TEST_F(RunContenders, KeepWhatIsDoneWhenStopped) {
    enter("a", 7);
    enter("b", 7);
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(3)}));
    // The call during which the run is stopped is not kept: a has two timed calls, b has one.
    ASSERT_TRUE(run(5, [&] { return calls.size() >= 7; }));
    EXPECT_FALSE(result.complete);
    ASSERT_EQ(result.measurements.size(), 2u);
    EXPECT_EQ(result.measurements[0].seconds.size(), 2u);
    EXPECT_EQ(result.measurements[1].seconds.size(), 1u);
}

TEST_F(RunContenders, LeaveOutWhatWasNotTimed) {
    enter("a", 7);
    enter("b", 7);
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(3)}));
    ASSERT_TRUE(run(5, [&] { return calls.size() >= 5; }));
    ASSERT_EQ(result.measurements.size(), 1u);
    EXPECT_EQ(result.measurements[0].entrant, 0u);
}

TEST_F(RunContenders, HandOnWhatAContenderSays) {
    enter("a", 7);
    workloads.push_back(ray_workload({"rays", RayQuery::Occlusion, std::vector<Ray>(3)}));
    const Result<Done> done = run(1);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "reference does not do that");
}

TEST_F(RunContenders, MeasureHowFarDistancesAreOff) {
    enter("a", 7);
    workloads.push_back(ray_workload({"rays", RayQuery::Nearest, std::vector<Ray>(3)}));
    ASSERT_TRUE(run(1));
    ASSERT_TRUE(result.measurements[0].error);
    EXPECT_EQ(result.measurements[0].error->largest, 0);
}

TEST(DistanceError, IsRelativeAndOfWhatBothHit) {
    const double none = std::numeric_limits<double>::infinity();
    const DistanceError error = distance_error(std::vector{1.0, 2.2, none, 5.0, none},
                                               std::vector{1.0, 2.0, 3.0, none, none});
    EXPECT_NEAR(error.largest_ulps, std::ldexp(0.2, 22), 1e-6); // a float's step at 2 is 2^-22
    EXPECT_NEAR(error.largest, 0.1, 1e-12);
    EXPECT_NEAR(error.rms, 0.1 / std::sqrt(2), 1e-12);
    EXPECT_EQ(distance_error(std::vector{0.5}, std::vector{0.0}).largest, 1);
    EXPECT_EQ(distance_error(std::vector{none}, std::vector{none}).rms, 0);
}

TEST(Checksum, IsFnv1a) {
    // The hash of the 8 bytes of "foobar!!" was computed by a few lines of Python.
    EXPECT_EQ(checksum(std::vector<uint64_t>{0x21217261626f6f66u}), 0x745faceb4ecb0edeu);
    EXPECT_EQ(checksum({}), 0xcbf29ce484222325u);
    EXPECT_NE(checksum(std::vector<uint64_t>{1, 2}), checksum(std::vector<uint64_t>{2, 1}));
}

} // namespace
} // namespace ovc
