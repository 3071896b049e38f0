// SPDX-License-Identifier: Apache-2.0
// Ranks that share a scene out answer bit for bit what one process answers, whoever asks.
#include "plugin/ranks/ranked_scene.h"

#include "plugin/ranks/sharing.h"
#include "plugin/ranks/transport/memory_transport.h"
#include "plugin/two_level/test_two_level.h"

#include <algorithm>
#include <functional>
#include <thread>

namespace ovc {
namespace {

using test::MemoryTransport;
using test::ok;

/// Several ranks of one scene, in threads.
class RankedGl : public TwoLevelGl {
protected:
    struct Rank {
        MemoryTransport* transport = nullptr;
        std::unique_ptr<RankedScene> scene;
        uint64_t pages = 0, bytes = 0;
    };

    std::vector<Rank> make(const Soup& soup, uint32_t count, const TwoLevelOptions& options,
                           uint64_t everywhere_bytes = 0,
                           const std::vector<uint64_t>& budgets = {}) {
        auto transports = MemoryTransport::make(count);
        std::vector<Rank> ranks(count);
        for (uint32_t rank = 0; rank < count; ++rank) {
            SharingOptions share{.rank = rank};
            share.shares = {count, everywhere_bytes};
            const LogSink log;
            Sharing sharing(share, log);
            TwoLevelOptions here = options;
            here.choose_pages = [&](const BuiltScene& scene) { return sharing.choose(scene); };
            if (!budgets.empty())
                here.budget_bytes = budgets[rank];
            std::unique_ptr<TwoLevel> local = build(soup, here);
            if (!local)
                return {};
            ranks[rank].transport = transports[rank].get();
            ranks[rank].pages = local->scene().pages.size();
            ranks[rank].bytes = local->scene().level2_bytes();
            ranks[rank].scene = std::make_unique<RankedScene>(
                soup,
                RankedParts{std::move(transports[rank]), std::move(local), sharing.take_finder()});
        }
        return ranks;
    }
    /// Calls of_rank(number, scene) for each rank, all at once.
    static void on_all(std::vector<Rank>& ranks,
                       const std::function<void(size_t, RankedScene&)>& of_rank) {
        std::vector<std::thread> threads;
        for (size_t i = 0; i < ranks.size(); ++i)
            threads.emplace_back([&, i] { of_rank(i, *ranks[i].scene); });
        for (std::thread& thread : threads)
            thread.join();
    }
    /// Destroys the scenes, each of which waits for the others.
    static void end(std::vector<Rank>& ranks) {
        std::vector<std::thread> threads;
        for (Rank& rank : ranks)
            threads.emplace_back([&] { rank.scene.reset(); });
        for (std::thread& thread : threads)
            thread.join();
    }
};

TEST_F(RankedGl, EqualsBruteForceBitForBit) {
    uint32_t number = 0;
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const uint32_t count : number++ == 0 ? std::vector{1u, 5u} : std::vector{3u}) {
            SCOPED_TRACE(name + ", " + std::to_string(count) + " ranks");
            const auto rays = test::unpleasant_rays(soup, 40 + count, 500);
            const std::vector<Hit> expected = test::brute_force(soup, rays);
            auto ranks = make(soup, count, {.leaf_triangles = 40});
            ASSERT_EQ(ranks.size(), count);
            on_all(ranks, [&](size_t i, RankedScene& scene) {
                // The calls have different lengths, and rank 2 asks nothing.
                const size_t first = i == 2 ? rays.size() : i * 50;
                test::expect_answers(scene, std::span(rays).subspan(first),
                                     std::span(expected).subspan(first));
            });
            end(ranks);
        }
}

TEST_F(RankedGl, SharesPagesOutEvenly) {
    const Soup soup = test::closed_grid(80);
    auto ranks = make(soup, 4, {.leaf_triangles = 100});
    ASSERT_EQ(ranks.size(), 4u);
    const auto whole = build(soup, {.leaf_triangles = 100});
    ASSERT_TRUE(whole);
    uint64_t pages = 0, bytes = 0, max = 0;
    for (const Rank& rank : ranks) {
        pages += rank.pages;
        bytes += rank.bytes;
        max = std::max(max, rank.bytes);
    }
    EXPECT_EQ(pages, whole->scene().pages.size());
    EXPECT_EQ(bytes, whole->scene().level2_bytes());
    EXPECT_LT(double(max), 1.25 * double(bytes) / 4);
    end(ranks);
}

/// Some triangles of the soup in several places, beside others that are placed once.
Soup instances() {
    Soup soup = test::closed_grid(24);
    soup.chunks.push_back(std::move(test::random_soup(5, 3000, 0.1).chunks.front()));
    test::Random random(6);
    for (int i = 0; i < 9; ++i) {
        Chunk chunk = soup.chunks[1].instance();
        Transform place = kIdentity;
        for (auto& row : place.rows)
            row[3] = random(-1, 1);
        place.rows[0][1] = random(-0.5, 0.5);
        chunk.place(place);
        chunk.set_mask(i % 2 ? 1 : 2);
        soup.chunks.push_back(std::move(chunk));
    }
    return soup;
}

TEST_F(RankedGl, SharesInstancesOut) {
    const Soup soup = instances();
    const auto rays = test::unpleasant_rays(soup, 50, 300);
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    struct {
        uint64_t budget, everywhere;
    } const cases[] = {{uint64_t(112) << 10, 0}, {0, uint64_t(64) << 10}};
    for (const auto& [budget, everywhere] : cases) {
        auto ranks = make(soup, 3, {.budget_bytes = budget, .leaf_triangles = 100}, everywhere);
        ASSERT_EQ(ranks.size(), 3u);
        on_all(ranks,
               [&](size_t, RankedScene& scene) { test::expect_answers(scene, rays, expected); });
        end(ranks);
    }
}

TEST_F(RankedGl, TracesNothingThroughASceneThatChanges) {
    const Soup soup = test::closed_grid(24);
    const auto rays = test::rays_from_outside(56, 1000);
    auto ranks = make(soup, 2, {.leaf_triangles = 100});
    ASSERT_EQ(ranks.size(), 2u);
    ranks[0].scene->leave_soup(); // the host now changes its copy, and the other rank asks still
    std::vector<Hit> hits(rays.size());
    const Result<Done> done = ranks[1].scene->intersect(rays, {}, hits);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, ErrorKind::InvalidState);
    EXPECT_EQ(done.error().message.find("rank 0 on here: the scene has changed there"), 0u);
    end(ranks);
}

TEST_F(RankedGl, CutsAlikeUnderOtherBudgets) {
    const Soup soup = test::closed_grid(80);
    const auto rays = test::unpleasant_rays(soup, 55, 300);
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    const std::vector<uint64_t> budgets{0, uint64_t(112) << 10, uint64_t(512) << 10};
    TwoLevelOptions options{.budget_bytes = budgets[1], .leaves = 24};
    const Result<MemoryPlan> smallest = plan_memory(soup, options, gl->info());
    ASSERT_TRUE(smallest);
    options.cut_pool_bytes = smallest->pool_bytes;
    auto ranks = make(soup, uint32_t(budgets.size()), options, 0, budgets);
    ASSERT_EQ(ranks.size(), budgets.size());
    on_all(ranks, [&](size_t, RankedScene& scene) { test::expect_answers(scene, rays, expected); });
    end(ranks);
}

/// Lets prims count that are no multiple of three, and remembers that it was asked in order.
class SomePrims final : public HitFilter {
public:
    bool keep(std::span<const uint64_t>, std::span<const Hit> hits,
              std::span<uint8_t> keep) override {
        for (size_t i = 0; i < hits.size(); ++i)
            keep[i] = hits[i].id.prim % 3 != 0;
        return true;
    }
};

TEST_F(RankedGl, KnowsWhatCounts) {
    const Soup soup = instances();
    const auto rays = test::unpleasant_rays(soup, 51, 200);
    const auto alone = build(soup, {.leaf_triangles = 100});
    auto ranks = make(soup, 3, {.leaf_triangles = 100});
    ASSERT_TRUE(alone);
    ASSERT_EQ(ranks.size(), 3u);
    std::vector<Hit> nearest(rays.size());
    ASSERT_TRUE(ok(alone->intersect(rays, {}, nearest)));
    std::vector<TriangleId> skip;
    for (const Hit& hit : nearest)
        skip.push_back(hit.id);
    std::vector<uint32_t> masks(rays.size());
    for (size_t i = 0; i < masks.size(); ++i)
        masks[i] = uint32_t(i % 4);
    SomePrims some;
    HitFilter* filter = &some;
    std::vector<Exclusions> all(6);
    all[0].skip = skip;
    all[1].after = nearest;
    all[2].sieves.masks = masks;
    all[3].sieves.filters = {&filter, 1};
    all[4] = Exclusions(skip, nearest);
    all[5].sieves = {masks, {&filter, 1}, {}, 0};
    for (const Exclusions& without : all) {
        std::vector<Hit> expected(rays.size());
        std::vector<uint8_t> shadows(rays.size());
        constexpr size_t kMaxHits = 5;
        std::vector<Hit> many(rays.size() * kMaxHits);
        std::vector<uint64_t> counts(rays.size());
        ASSERT_TRUE(ok(alone->intersect(rays, without, expected)));
        ASSERT_TRUE(ok(alone->occluded(rays, without, shadows)));
        ASSERT_TRUE(ok(alone->all_hits(rays, without, {kMaxHits, many, counts})));
        on_all(ranks, [&](size_t, RankedScene& scene) {
            std::vector<Hit> hits(rays.size()), some_hits(many.size());
            std::vector<uint8_t> occluded(rays.size());
            std::vector<uint64_t> some_counts(rays.size());
            ASSERT_TRUE(ok(scene.intersect(rays, without, hits)));
            ASSERT_TRUE(ok(scene.occluded(rays, without, occluded)));
            ASSERT_TRUE(ok(scene.all_hits(rays, without, {kMaxHits, some_hits, some_counts})));
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(test::same(hits[i], expected[i])) << "ray " << i;
                ASSERT_EQ(occluded[i], shadows[i]) << "ray " << i;
                ASSERT_EQ(some_counts[i], counts[i]) << "ray " << i;
            }
            for (size_t i = 0; i < many.size(); ++i)
                ASSERT_TRUE(test::same(some_hits[i], many[i])) << i;
        });
    }
    end(ranks);
}

TEST_F(RankedGl, AnswersAStreamAsOneProcessDoes) {
    const Soup soup = instances();
    const auto rays = test::rays_from_outside(54, 30'000);
    const auto alone = build(soup, {.leaf_triangles = 100});
    auto ranks = make(soup, 3, {.leaf_triangles = 100});
    ASSERT_TRUE(alone);
    ASSERT_EQ(ranks.size(), 3u);
    SomePrims some;
    HitFilter* filter = &some;
    for (const bool filtered : {false, true}) {
        test::Spawner expected(rays, 5000);
        if (filtered)
            expected.filters = {&filter, 1};
        ASSERT_TRUE(ok(alone->stream(expected)));
        on_all(ranks, [&](size_t i, RankedScene& scene) {
            test::Spawner host(rays, 7000 * i + 100);
            host.filters = expected.filters;
            ASSERT_TRUE(ok(scene.stream(host)));
            EXPECT_EQ(host.blocked, expected.blocked);
            for (size_t ray = 0; ray < rays.size(); ++ray)
                ASSERT_TRUE(test::same(host.hits_of[ray], expected.hits_of[ray])) << ray;
        });
    }
    EXPECT_GE(ranks[0].scene->report().nearest_rays, 2 * rays.size());
    test::Spawner stopped(rays, 5000);
    stopped.stop_after = 1;
    const Result<Done> done = ranks[0].scene->stream(stopped);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, ErrorKind::Cancelled);
    // Messages that it has left on their way disturb no call after it.
    on_all(ranks, [&](size_t, RankedScene& scene) {
        test::expect_answers(scene, std::span(rays).first(200),
                             test::brute_force(soup, std::span(rays).first(200)));
    });
    end(ranks);
}

TEST_F(RankedGl, SaysWhoIsLost) {
    const Soup soup = test::closed_grid(24);
    auto ranks = make(soup, 3, {.leaf_triangles = 40});
    ASSERT_EQ(ranks.size(), 3u);
    ranks[0].transport->lose(2);
    const auto rays = test::rays_from_outside(52, 100);
    std::vector<Hit> hits(rays.size());
    const Result<Done> done = ranks[0].scene->intersect(rays, {}, hits);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "rank 2 on here is lost");
    end(ranks);
}

TEST_F(RankedGl, ARankWithoutMemoryForItsAnswersIsLost) {
    const Soup soup = test::closed_grid(24);
    auto ranks = make(soup, 2, {.leaf_triangles = 40});
    ASSERT_EQ(ranks.size(), 2u);
    ranks[0].transport->refuse_memory();
    const auto rays = test::rays_from_outside(55, 1000);
    std::vector<Hit> hits(rays.size());
    const Result<Done> done = ranks[1].scene->intersect(rays, {}, hits);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message, "rank 0 on here is lost");
    const std::optional<Error> own = ranks[0].transport->lost();
    ASSERT_TRUE(own);
    EXPECT_EQ(own->kind, ErrorKind::OutOfMemory);
    end(ranks);
}

/// Tells a call to stop.
struct Impatient final : TraceWatch {
    bool goes_on(double) override { return false; }
};

TEST_F(RankedGl, AnswersAfterACallThatWasCancelled) {
    const Soup soup = test::closed_grid(24);
    auto ranks = make(soup, 2, {.leaf_triangles = 40});
    ASSERT_EQ(ranks.size(), 2u);
    const auto rays = test::rays_from_outside(53, 20'000);
    RankedScene& scene = *ranks[0].scene;
    std::vector<Hit> hits(rays.size());
    {
        Impatient watch;
        const CallWatch::Scope scope(scene.call_watch(), &watch);
        const Result<Done> done = scene.intersect(rays, {}, hits);
        ASSERT_FALSE(done);
        EXPECT_EQ(done.error().kind, ErrorKind::Cancelled);
    }
    test::expect_answers(scene, std::span(rays).first(500),
                         test::brute_force(soup, std::span(rays).first(500)));
    EXPECT_GT(scene.report().rays_sent, 0u);
    end(ranks);
}

} // namespace
} // namespace ovc
