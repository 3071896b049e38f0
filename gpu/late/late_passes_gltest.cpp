// SPDX-License-Identifier: Apache-2.0
// Two passes under way together give the answers of passes one by one, however late the driver
// does what it is asked for.
#include "gpu/gl/test_gl.h"
#include "gpu/late/late_gl.h"
#include "gpu/trace/tracer.h"
#include "kdtree/test_soups.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <list>
#include <ostream>
#include <string>

namespace ovc {

static bool operator==(const Answer& a, const Answer& b) {
    return a.words == b.words && a.prim == b.prim && a.where == b.where &&
           std::ranges::equal(a.listed, b.listed);
}

namespace {

constexpr size_t kBatches = 10, kRays = 1500;

struct LateWay {
    bool compute;
    bool software; // as a software renderer's passes are run, which are not timed by queries

    std::string name() const {
        return std::string(compute ? "Compute" : "Fragment") + (software ? "" : "OfGpu");
    }
    friend void PrintTo(const LateWay& way, std::ostream* out) { *out << way.name(); }
};

class LatePassesGl : public test::OnGl, public testing::WithParamInterface<LateWay> {
protected:
    void SetUp() override {
        OnGl::SetUp();
        if (!gl)
            return;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        Level1 level1 = partition(soup, ids, bounds, uint32_t(ids.size() / 40));
        share_frame(level1);
        for (const Leaf& leaf : level1.leaves)
            pages.push_back(build_page(soup, numbers, leaf));
        top = build_top_level(pages, pages.size());
        device = gl->info();
        device.takes_host_pages = false;
        device.is_software = device.is_software && GetParam().software;
    }

    std::unique_ptr<Tracer> make_tracer(GlState& state) {
        MemoryPlan plan = *plan_memory(4u << 20, device);
        EXPECT_GE(plan.batch_rays, kRays);
        uint64_t largest = 0;
        for (const Page& page : pages)
            largest = std::max(largest, page.bytes());
        plan.pool_bytes = top.room() + 8 * largest;
        auto made = Tracer::create(plan, {.variants = default_variants(device, GetParam().compute)},
                                   device, state.kernels, bounds, pages, top);
        EXPECT_TRUE(made) << made.error().message;
        return made ? std::move(*made) : nullptr;
    }

    /// Traces the batches, and moves other pages in beside each. Returns all answers.
    std::vector<std::vector<Answer>> traced(Tracer& tracer, size_t passes_in_flight, bool moves) {
        test::Random random(8);
        std::array<SentRays, 3> sent;
        std::vector<std::vector<Answer>> answers(kBatches, std::vector<Answer>(kRays));
        std::vector<Tracer::Pass> passes;
        tracer.bring(tracer.missing());
        const auto collect = [&](size_t i) {
            Answers& all = collected.emplace_back();
            EXPECT_TRUE(tracer.collect(passes[i], all));
            for (size_t ray = 0; ray < kRays; ++ray)
                answers[i][ray] = all[ray];
            sent[i % sent.size()] = {};
        };
        for (size_t i = 0; i < kBatches; ++i) {
            std::vector<RayState> states(kRays);
            for (RayState& state : states) {
                const dvec3 org = random.point(-3, 3);
                state.ray = {org, 0, random.point(-1, 1) - org};
            }
            sent[i % sent.size()] = send(tracer.form(), states);
            const Result<Tracer::Pass> pass = tracer.submit(sent[i % sent.size()]);
            EXPECT_TRUE(pass);
            passes.push_back(pass ? *pass : 0);
            std::vector<uint32_t> wanted = tracer.missing();
            wanted.resize(moves ? std::min<size_t>(wanted.size(), 3) : 0);
            tracer.bring(wanted);
            if (i + 1 >= passes_in_flight)
                collect(i + 1 - passes_in_flight);
        }
        for (size_t i = kBatches + 1 - passes_in_flight; i < kBatches; ++i)
            collect(i);
        return answers;
    }

    std::vector<std::vector<Answer>> one_by_one(bool moves) {
        return gl->run([&](GlState& state) {
            device.passes_in_flight = 1;
            return traced(*make_tracer(state), 1, moves);
        });
    }
    std::vector<std::vector<Answer>> late(unsigned seed, bool moves,
                                          LateGl::Lie lie = LateGl::Lie::None) {
        return gl->run([&](GlState& state) {
            device.passes_in_flight = 2;
            LateGl driver(seed, lie);
            auto answers = traced(*make_tracer(state), 2, moves);
            EXPECT_GE(driver.max_shaders(), 2u) << "two passes were under way";
            return answers;
        });
    }

    std::list<Answers> collected; // to which answers refer
    const Soup soup = test::closed_grid(40);
    const Numbering numbers{soup};
    Box bounds;
    std::vector<Page> pages;
    TopLevel top;
    DeviceInfo device;
};
INSTANTIATE_TEST_SUITE_P(Kernel, LatePassesGl,
                         testing::Values(LateWay{false, true}, LateWay{false, false},
                                         LateWay{true, true}, LateWay{true, false}),
                         [](const auto& p) { return p.param.name(); });

TEST_P(LatePassesGl, AnswerAsPassesOneByOneDo) {
    const auto expected = one_by_one(/* moves= */ true);
    size_t waits = 0;
    for (const auto& answers : expected)
        waits += size_t(std::ranges::count_if(
            answers, [](const Answer& answer) { return answer.where != OVC_NO_LEAF; }));
    EXPECT_GT(waits, 100u) << "pages must matter";
    for (unsigned seed = 0; seed < 4; ++seed)
        EXPECT_EQ(late(seed, /* moves= */ true), expected) << "seed " << seed;
}

TEST_P(LatePassesGl, TheTestSeesAFenceThatIsNotWaitedFor) {
    EXPECT_NE(late(1, /* moves= */ false, LateGl::Lie::FencesArePassed), one_by_one(false));
}

TEST_P(LatePassesGl, TheTestSeesABarrierThatIsMissing) {
    if (!GetParam().compute)
        GTEST_SKIP() << "what a fragment shader draws needs no barrier";
    EXPECT_NE(late(1, /* moves= */ false, LateGl::Lie::BarriersDoNothing), one_by_one(false));
}

} // namespace
} // namespace ovc
