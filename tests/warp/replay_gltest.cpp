// SPDX-License-Identifier: Apache-2.0
// The kernel's source as C++ takes the rounds and fetches the units that the kernel itself counts.
#include "tests/warp/replay.h"

#include "gpu/gl/test_gl.h"
#include "gpu/trace/tracer.h"
#include "kdtree/test_soups.h"
#include "tests/warp/pooled_scene.h"
#include "tests/warp/warp_model.h"

namespace ovc {
namespace {

constexpr size_t kRays = 100000;

class ReplayGl : public test::OnGl {
protected:
    /// Returns what the kernel answers, with its counts.
    Answers trace(const PooledScene& scene, const KernelVariant& variant, std::span<const Ray> rays,
                  bool any_hit) {
        std::vector<RayState> states(rays.size());
        for (size_t i = 0; i < rays.size(); ++i)
            states[i] = {.ray = rays[i], .asks = any_hit ? OVC_RAY_ANY_HIT : 0};
        Answers answers;
        gl->run([&](GlState& state) {
            plan = *plan_memory(256u << 20, gl->info());
            const PassOptions options{.variants = ChosenVariants(variant), .counts = true};
            auto tracer = Tracer::create(plan, options, gl->info(), state.kernels,
                                         scene.level1.bounds, scene.pages, scene.top);
            ASSERT_TRUE(tracer) << tracer.error().message;
            (*tracer)->bring((*tracer)->missing());
            ASSERT_TRUE((*tracer)->all_resident());
            SentRays sent = send((*tracer)->form(), states);
            ASSERT_TRUE((*tracer)->trace(sent, answers));
        });
        return answers;
    }

    /// Compares both for each ray, or each packet.
    void expect_same_counts(const PooledScene& scene, const ReplayedVariant& how,
                            std::span<const Ray> rays) {
        const KernelVariant variant{.packets = how.packets,
                                    .branches = how.branches,
                                    .stack = StackPlace::Registers,
                                    .stack_words = 32};
        const Answers answers = trace(scene, variant, rays, how.any_hit);
        PagedVector<LocalRay> slots = scene.local_rays(rays, how.any_hit);
        LocalRay none{};
        none.t_end = OVC_NO_RAY;
        slots.resize(whole_blocks(slots.size()), none);
        std::vector<size_t> slot_of(rays.size());
        for (size_t i = 0; i < rays.size(); ++i)
            slot_of[i] = i;
        if (how.packets) {
            const size_t most = plan.batch_rays + plan.parted_rays();
            const auto parted = part_packets(slots, rays.size(), most);
            ASSERT_TRUE(parted);
            for (const Parted& p : *parted)
                slot_of[p.ray] = p.slot;
        }
        const std::vector<Steps> steps = replay(how, scene.pool, slots);
        size_t different = 0;
        uint64_t rounds = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const size_t packet = how.packets ? 2 : 1;
            const Steps& expected = steps[slot_of[i] / packet];
            const bool second = slot_of[i] % packet == 1;
            rounds += expected.rounds;
            const Answer answer = answers[i];
            different +=
                answer.further()[0] != expected.rounds ||
                answer.further()[1] != expected.units.size() ||
                answer.prim != ((second ? expected.second_prim : expected.prim) & ~OVC_SAYS_MORE);
        }
        EXPECT_EQ(different, 0u);
        EXPECT_GT(rounds, 2 * rays.size());
    }

    MemoryPlan plan;
};

TEST_F(ReplayGl, CountsWhatTheKernelCounts) {
    const PooledScene scene(test::random_soup(7, 20000, 0.1), 6);
    const Box& box = scene.level1.bounds;
    test::Random random(3);
    std::vector<Ray> rays;
    for (size_t i = 0; i < kRays; ++i)
        rays.push_back({box.lo + random.point(-0.2, 1.2) * box.extent(), 0, random.point(-1, 1)});
    for (const bool branches : {false, true})
        for (const bool any_hit : {false, true}) {
            SCOPED_TRACE(testing::Message() << "branches " << branches << ", any hit " << any_hit);
            expect_same_counts(scene, {any_hit, branches, false}, rays);
        }
}

TEST_F(ReplayGl, CountsPacketsToo) {
    const PooledScene scene(test::random_soup(7, 20000, 0.1), 1);
    std::vector<Ray> rays;
    for (size_t i = 0; i < kRays; ++i)
        rays.push_back({dvec3(0.5, 0.5, -3), 0,
                        dvec3(double(i % 316) / 316 - 0.5, double(i / 316) / 316 - 0.5, 3)});
    expect_same_counts(scene, {false, false, true}, rays);
    expect_same_counts(scene, {true, false, true}, rays);
}

/// Lanes that take `rounds` each, of a node and its line.
std::vector<Steps> lanes(std::initializer_list<uint32_t> rounds) {
    std::vector<Steps> all;
    for (const uint32_t count : rounds) {
        Steps& steps = all.emplace_back();
        for (uint32_t i = 0; i < count + 1; ++i) {
            steps.units.push_back(i);
            steps.is_pair.push_back(false);
        }
    }
    return all;
}

TEST(WarpModel, CountsLanesAndLines) {
    const Gpu gpu{.l1_bytes = 1 << 17, .l2_bytes = 1 << 20};
    const WarpWork work = run_warps({.branches = true}, lanes({4, 2}), 2, gpu);
    EXPECT_EQ(work.warp_rounds, 4u);
    EXPECT_EQ(work.lane_rounds, 6u);
    EXPECT_EQ(work.lines, 4u);     // both lanes want the same unit in each round
    EXPECT_EQ(work.l1_misses, 3u); // units 1; 2 and 3; 4
    EXPECT_EQ(work.l2_misses, 3u);
    EXPECT_EQ(work.pair_rounds, 0u);
    const Gpu tiny{.l1_bytes = kLineBytes, .l2_bytes = kLineBytes};
    const std::vector<Steps> one = lanes({4});
    EXPECT_EQ(run_warps({.branches = true}, one, 1, tiny).l1_misses, 3u);
}

TEST(WarpModel, RefillKeepsLanesBusy) {
    const Gpu gpu{.l1_bytes = 1 << 17, .l2_bytes = 1 << 20};
    std::vector<Steps> slots;
    for (int i = 0; i < 512; ++i)
        slots.push_back(lanes({i % 7 == 0 ? 60u : 6u}).front());
    const WarpWork once = run_warps({.branches = true}, slots, slots.size(), gpu);
    const WarpWork refilled =
        run_warps({.branches = true, .refill = true}, slots, slots.size(), gpu);
    EXPECT_EQ(once.lane_rounds, refilled.lane_rounds);
    EXPECT_GT(refilled.active_lanes(), 1.3 * once.active_lanes());
}

} // namespace
} // namespace ovc
