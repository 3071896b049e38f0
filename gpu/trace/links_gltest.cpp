// SPDX-License-Identifier: Apache-2.0
// Whatever pages are in the pool, a ray comes to each leaf on its way once, and meets all triangles
// of the scene on its way.
#include "gpu/gl/test_gl.h"
#include "gpu/trace/tracer.h"
#include "kdtree/test_soups.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace ovc {
namespace {

class LinksGl : public test::OnGl, public testing::WithParamInterface<bool> {
protected:
    void SetUp() override {
        OnGl::SetUp();
        if (!gl)
            return;
        Box bounds;
        ids = hittable_triangles(soup, nullptr, &bounds);
        level1 = partition(soup, ids, bounds, uint32_t(ids.size() / 40));
        share_frame(level1);
        uint64_t largest = 0;
        for (const Leaf& leaf : level1.leaves) {
            pages.push_back(build_page(soup, numbers, leaf));
            largest = std::max(largest, pages.back().bytes());
        }
        top = build_top_level(pages, pages.size());
        gl->run([&](GlState& state) {
            MemoryPlan plan = *plan_memory(64u << 20, gl->info());
            plan.pool_bytes = 4 * largest;
            tracer = std::move(
                *Tracer::create(plan, {.variants = default_variants(gl->info(), GetParam())},
                                gl->info(), state.kernels, level1.bounds, pages, top));
        });
        ASSERT_FALSE(tracer->all_resident());
    }
    void TearDown() override {
        if (gl)
            gl->run([&](GlState&) { tracer.reset(); });
    }

    /// A ray on its way: the links that it has waited for, by their keys, and its hits so far.
    struct UnderWay {
        Ray ray;
        Hit hit{};               // the nearest so far
        double limit = INFINITY; // nothing beyond can be nearer
        std::vector<uint32_t> waited{};
        bool decided = true;

        RayState state() const {
            Ray rest = ray;
            rest.t_max = limit;
            return {.ray = rest, .asks = waited.empty() ? 0 : waited.back()};
        }
    };

    void take_in(UnderWay& way, const Answer& answer) {
        way.decided = way.decided && answer.prim != OVC_FLAGGED;
        const PreparedRay p(way.ray);
        Nearest nearest(p);
        const auto offer = [&](TriangleId id) { nearest.offer(soup.triangle(id), id); };
        if (way.hit.is_hit())
            offer(way.hit.id);
        const auto offer_number = [&](uint32_t number) {
            if (number < OVC_MAX_TRIANGLES)
                offer(numbers.id(number));
        };
        offer_number(answer.prim);
        if (answer.prim != OVC_FLAGGED)
            std::ranges::for_each(answer.further(), offer_number);
        way.hit = nearest.hit();
        way.limit = nearest.limit();
    }

    /// Runs a pass of these rays; those that wait join the queues.
    void pass(std::vector<UnderWay>& rays, std::span<const uint32_t> some) {
        std::vector<RayState> states(some.size());
        for (size_t j = 0; j < some.size(); ++j)
            states[j] = rays[some[j]].state();
        Answers answers;
        gl->run([&](GlState&) {
            SentRays sent = send(tracer->form(), states);
            ASSERT_TRUE(tracer->trace(sent, answers));
        });
        for (size_t j = 0; j < some.size(); ++j) {
            UnderWay& way = rays[some[j]];
            const Answer answer = answers[j];
            take_in(way, answer);
            const uint32_t key = answer.where;
            if (key == OVC_NO_LEAF)
                continue;
            ASSERT_LT(leaf_of(key), pages.size());
            ASSERT_TRUE(way.waited.empty() || key > way.waited.back())
                << "ray " << some[j] << " waits for " << key << " after " << way.waited.back();
            ASSERT_EQ(std::ranges::count(way.waited, leaf_of(key), leaf_of), 0)
                << "ray " << some[j] << " waits again for leaf " << leaf_of(key);
            way.waited.push_back(key);
            queues[leaf_of(key)].push_back(some[j]);
        }
    }

    const Soup soup = test::closed_grid(40);
    const Numbering numbers{soup};
    std::vector<TriangleId> ids;
    Level1 level1;
    std::vector<Page> pages;
    TopLevel top;
    std::unique_ptr<Tracer> tracer;
    std::map<uint32_t, std::vector<uint32_t>> queues; // rays, by the leaf that they wait for
};
INSTANTIATE_TEST_SUITE_P(Kernel, LinksGl, testing::Bool(),
                         [](const auto& p) { return p.param ? "Compute" : "Fragment"; });

TEST_P(LinksGl, ARayIsDoneWithEachLeafForGood) {
    test::Random random(8);
    std::vector<UnderWay> rays;
    for (int i = 0; i < 3000; ++i) {
        const dvec3 org = random.point(-3, 3);
        rays.push_back({Ray{org, 0, random.point(-1, 1) - org}});
    }
    std::vector<uint32_t> some(rays.size());
    std::iota(some.begin(), some.end(), 0u);
    pass(rays, some);
    while (!queues.empty() && !HasFatalFailure()) {
        // Any page may come next.
        const auto next = std::next(queues.begin(), ptrdiff_t(random.below(queues.size())));
        const uint32_t leaf = next->first;
        const std::vector<uint32_t> queue = std::move(next->second);
        queues.erase(next);
        gl->run([&](GlState&) { ASSERT_EQ(tracer->bring(std::vector<uint32_t>{leaf}).pages, 1u); });
        pass(rays, queue);
    }
    size_t waits = 0, decided = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        waits += rays[i].waited.size();
        if (!rays[i].decided)
            continue;
        ++decided;
        ASSERT_TRUE(test::same(rays[i].hit, test::brute_force(soup, ids, rays[i].ray)))
            << "ray " << i;
    }
    EXPECT_GT(waits, rays.size());
    EXPECT_GT(decided, rays.size() * 9 / 10);
}

} // namespace
} // namespace ovc
