// SPDX-License-Identifier: Apache-2.0
// A build out of core makes the levels of a build in memory, to the last bit where nothing but the
// budget of host memory limits leaves, and levels of the same answers elsewhere.
#include "plugin/out_of_core/streamed_build.h"

#include "core/file/test_archive.h"
#include "core/system/parallel.h"
#include "kdtree/test_soups.h"
#include "plugin/build/build_scene.h"
#include "plugin/build/restored_levels.h"
#include "plugin/build/same_levels_test.h"
#include "plugin/build/saved_levels.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/out_of_core/test_source.h"

#include <gtest/gtest.h>

#include <optional>

namespace ovc {
namespace {

using test::ArchiveMemory;
using test::ScratchMemory;
using test::SoupSource;
using test::StepMemory;

constexpr uint64_t kSmall = 8 << 20; // enough for a few threads

/// Limits the threads of a test.
class StreamedBuild : public testing::Test {
    LoopThreads threads_{4};
    LoopThreads::Scope scope_{threads_};
};

MemoryPlan plan_of(uint64_t pool_bytes) {
    return {.budget_bytes = pool_bytes, .pool_bytes = pool_bytes, .buffer_bytes = pool_bytes};
}

/// The scene of a soup that was built out of core, saved and restored.
struct Streamed {
    ArchiveMemory saved;
    StreamedLevels told;
    std::optional<BuiltScene> scene;

    Streamed(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
             uint64_t host_bytes = kSmall) {
        SoupSource source(soup);
        ScratchMemory scratch;
        const Result<StreamedLevels> done =
            stream_levels({source, scratch, host_bytes}, options, plan, saved.sink());
        EXPECT_TRUE(done) << done.error().message;
        if (!done)
            return;
        told = *done;
        Result<std::optional<BuiltScene>> restored = restore_levels(
            saved.bytes(), soup,
            [&](uint64_t triangles, uint64_t unique) {
                return limits_of(options, plan, triangles, unique);
            },
            /* takes_any_limits= */ true);
        EXPECT_TRUE(restored) << restored.error().message;
        if (restored && *restored)
            scene.emplace(std::move(**restored));
        EXPECT_TRUE(scene);
    }
};

/// Returns the answers of all rays, by the tree over the scene's pages.
std::vector<Hit> answers(BuiltScene& scene, std::span<const Ray> rays) {
    scene.top = top_level_of(scene, scene.pages.size());
    std::vector<Hit> hits;
    for (const Ray& ray : rays)
        if (ray.valid())
            hits.push_back(trace_exactly</* kAnyHit= */ false>(scene, PreparedRay(ray)));
    return hits;
}

void expect_same_answers(const Soup& soup, BuiltScene& a, BuiltScene& b) {
    const std::vector<Ray> rays = test::unpleasant_rays(soup, 17, 300);
    const std::vector<Hit> of_a = answers(a, rays), of_b = answers(b, rays);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (size_t i = 0; i < of_a.size(); ++i) {
        EXPECT_EQ(of_a[i].id, of_b[i].id) << i;
        EXPECT_EQ(of_a[i].t, of_b[i].t) << i;
        EXPECT_EQ(of_a[i].u, of_b[i].u) << i;
        EXPECT_EQ(of_a[i].v, of_b[i].v) << i;
    }
}

Soup several_meshes() {
    Soup soup = test::closed_grid(130);
    soup.chunks.push_back(Chunk::owning(dvec3(0), {}));
    for (Chunk& chunk : test::closed_grid(70, dvec3(1, 2, 0.3)).chunks)
        soup.chunks.push_back(std::move(chunk));
    std::vector<dvec3> doubles;
    for (const vec3& corner : soup.chunks[0].corners().first(3000))
        doubles.push_back(dvec3(corner) * 1.1 + dvec3(0, 0, 0.7));
    soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(doubles)));
    return soup;
}

TEST_F(StreamedBuild, MakesTheLevelsOfABuildInMemory) {
    auto soups = test::unpleasant_soups();
    soups.push_back({"sampled", test::closed_grid(180)});
    soups.push_back({"several", several_meshes()});
    size_t shared = 0;
    for (const auto& [name, soup] : soups) {
        SCOPED_TRACE(name);
        const MemoryPlan plan = plan_of(1 << 30);
        const TwoLevelOptions options{.leaf_triangles =
                                          soup.triangle_count() > 20000 ? 1000u : 60u};
        Streamed streamed(soup, options, plan, /* host_bytes= */ 8 * kSmall);
        Result<BuiltScene> in_memory = build_scene(soup, options, plan, {});
        ASSERT_TRUE(in_memory && streamed.scene);
        // A build out of core decides on frames by cells, one in memory by leaves, of which a cell
        // that cannot be cut may have several.
        if (in_memory->level1.shares_frame)
            test::expect_same(*in_memory, *streamed.scene);
        expect_same_answers(soup, *in_memory, *streamed.scene);
        EXPECT_EQ(streamed.told.leaves, in_memory->pages.size());
        shared += in_memory->level1.shares_frame;
        EXPECT_EQ(streamed.told.triangles, in_memory->triangles);
        EXPECT_TRUE(streamed.told.was_streamed);
    }
    EXPECT_GT(shared, soups.size() / 2);
}

TEST_F(StreamedBuild, HasTheSameAnswersWherePagesLimitLeaves) {
    for (const uint64_t pool : {200'000, 2'000'000}) {
        const Soup soup = several_meshes();
        const MemoryPlan plan = plan_of(pool);
        Streamed streamed(soup, {}, plan);
        Result<BuiltScene> in_memory = build_scene(soup, {}, plan, {});
        ASSERT_TRUE(in_memory && streamed.scene);
        const LeafLimits limits = limits_of({}, plan, soup.triangle_count());
        EXPECT_LE(streamed.scene->largest_page_bytes(), limits.page_bytes);
        expect_same_answers(soup, *in_memory, *streamed.scene);
    }
}

/// Duplicates, in one mesh and across meshes, are found although no list of all triangles is made.
TEST_F(StreamedBuild, FindsDuplicates) {
    Soup soup = test::closed_grid(100);
    soup.chunks.push_back(Chunk::owning(
        dvec3(0), {soup.chunks[0].corners().begin() + 300, soup.chunks[0].corners().end() - 900}));
    soup.chunks.push_back(Chunk::owning(
        dvec3(0), {soup.chunks[0].corners().begin(), soup.chunks[0].corners().end()}));
    const MemoryPlan plan = plan_of(1 << 30);
    Streamed streamed(soup, {.leaf_triangles = 500}, plan);
    Result<BuiltScene> in_memory = build_scene(soup, {.leaf_triangles = 500}, plan, {});
    ASSERT_TRUE(in_memory && streamed.scene);
    const auto expected = in_memory->duplicates.pairs(), found = streamed.scene->duplicates.pairs();
    EXPECT_TRUE(std::ranges::equal(expected, found));
    EXPECT_GT(found.size(), soup.chunks[0].size());
    EXPECT_EQ(in_memory->triangles, streamed.scene->triangles);
    expect_same_answers(soup, *in_memory, *streamed.scene);
}

TEST_F(StreamedBuild, RefusesTooSmallABudgetAndNamesOneThatWorks) {
    const Soup soup = test::closed_grid(120);
    const MemoryPlan plan = plan_of(1 << 30);
    SoupSource source(soup);
    ScratchMemory scratch;
    ArchiveMemory saved;
    const auto refused = stream_levels({source, scratch, 1 << 20}, {}, plan, saved.sink());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::OverBudget);
    EXPECT_EQ(saved.size(), 64u); // the header of the archive
    const std::string& sentence = refused.error().message;
    const uint64_t smallest = std::stoull(sentence.substr(sentence.rfind(' ') + 1));
    Streamed(soup, {}, plan, smallest);
}

/// Returns large triangles in one place, which no plane parts.
Soup heap_of(size_t count) {
    test::Random random(5);
    std::vector<vec3> corners;
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            corners.push_back(vec3(random.point(-1, 1)));
    return test::one_chunk(std::move(corners));
}

/// Returns a soup of a few triangles, of which there are many.
Soup copies_of_few(size_t count, size_t of) {
    const Soup few = heap_of(of);
    std::vector<vec3> corners;
    for (size_t i = 0; i < count; ++i)
        for (size_t k = 0; k < 3; ++k)
            corners.push_back(few.chunks[0].corners()[i % of * 3 + k]);
    return test::one_chunk(std::move(corners));
}

/// No plane parts them, or they are more than their sample makes believe. A build that needed more
/// memory for that would say so only once all of them are dealt.
TEST_F(StreamedBuild, AnySceneWorksWithTheSmallestBudget) {
    std::vector<std::pair<const char*, Soup>> soups;
    soups.emplace_back("heap", heap_of(20'000));
    soups.emplace_back("copies of 3", copies_of_few(30'000, 3));
    soups.emplace_back("copies of 2,000", copies_of_few(30'000, 2000));
    Soup& mixed = soups.emplace_back("mixed", heap_of(9'000)).second;
    for (Chunk& chunk : test::closed_grid(60).chunks)
        mixed.chunks.push_back(std::move(chunk));
    for (Chunk& chunk : copies_of_few(8'000, 40).chunks)
        mixed.chunks.push_back(std::move(chunk));
    const MemoryPlan plan = plan_of(1 << 30);
    for (const auto& [name, soup] : soups) {
        SCOPED_TRACE(name);
        Streamed streamed(soup, {}, plan, kSmall);
        Result<BuiltScene> in_memory = build_scene(soup, {}, plan, {});
        ASSERT_TRUE(in_memory && streamed.scene);
        expect_same_answers(soup, *in_memory, *streamed.scene);
        const HostBudget budget{kSmall, std::max(thread_count(), kMinThreads)};
        for (const Leaf& leaf : streamed.scene->level1.leaves)
            EXPECT_LE(leaf.list().size(), budget.leaf_triangles());
    }
}

TEST_F(StreamedBuild, EndsWhereAFunctionOfItsCallerFails) {
    const Soup soup = test::closed_grid(120);
    const MemoryPlan plan = plan_of(1 << 30);
    for (const int reads : {0, 3, 10}) {
        SoupSource source(soup);
        source.fail_after(reads);
        ScratchMemory scratch;
        ArchiveMemory saved;
        EXPECT_THROW((void)stream_levels({source, scratch, kSmall}, {}, plan, saved.sink()),
                     Cancelled);
    }
    SoupSource source(soup);
    ScratchMemory scratch;
    int writes = 0;
    const ByteSink full = [&](Bytes) { return ++writes < 3; };
    EXPECT_THROW((void)stream_levels({source, scratch, kSmall}, {}, plan, full), Cancelled);
    EXPECT_EQ(writes, 3);
    // Progress is asked every twentieth of a second or so, within which a small soup is built.
    const Soup large = test::closed_grid(300);
    SoupSource much(large);
    BuildProgress stops([&](double done, const char*) { return done < 0.3; });
    const ByteSink any = [](Bytes) { return true; };
    EXPECT_THROW((void)stream_levels({much, scratch, kSmall}, {}, plan, any, &stops), Cancelled);
}

/// A build that keeps its steps.
struct SteppedBuild {
    const Soup& soup;
    ScratchMemory scratch;
    ArchiveMemory saved;
    std::vector<std::vector<std::byte>> steps{};

    void run(StepMemory& keeper, uint64_t host_bytes = kSmall) {
        SoupSource source(soup);
        const MemoryPlan plan = plan_of(1 << 30);
        const auto done = stream_levels({source, scratch, host_bytes, &keeper},
                                        {.leaf_triangles = 700}, plan, saved.sink());
        EXPECT_TRUE(done) << done.error().message;
        steps = keeper.steps();
    }
};

TEST_F(StreamedBuild, GoesOnBehindAnyStepWithTheSameBytes) {
    const Soup soups[] = {several_meshes(), heap_of(12'000)}; // the latter in parts
    for (const Soup& soup : soups) {
        SteppedBuild whole{soup};
        StepMemory keeper;
        whole.run(keeper);
        ASSERT_GT(whole.steps.size(), 7u);
        for (size_t kept = 0; kept <= whole.steps.size(); ++kept) {
            SteppedBuild again{soup, ScratchMemory(whole.scratch)};
            StepMemory found(std::span(whole.steps).first(kept), whole.saved.bytes());
            again.run(found);
            EXPECT_EQ(again.steps.size(), whole.steps.size() - kept);
            ASSERT_EQ(again.saved.size(), whole.saved.size());
            EXPECT_TRUE(std::ranges::equal(again.saved.bytes(), whole.saved.bytes())) << kept;
        }
    }
}

TEST_F(StreamedBuild, RefusesStepsThatAreDamagedOrOfAnotherBuild) {
    const Soup soup = test::closed_grid(140);
    SteppedBuild whole{soup};
    StepMemory keeper;
    whole.run(keeper);
    const auto expect_refused = [&](auto steps, uint64_t host_bytes, const auto& spoil) {
        SteppedBuild again{soup, ScratchMemory(whole.scratch)};
        ArchiveMemory written(whole.saved.bytes());
        spoil(again, written);
        StepMemory found(steps, written.bytes());
        EXPECT_THROW(again.run(found, host_bytes), Failure);
    };
    const auto as_it_is = [](auto&, auto&) {};
    expect_refused(whole.steps, kSmall + 1, as_it_is);
    auto cut = whole.steps;
    cut[1].pop_back();
    expect_refused(cut, kSmall, as_it_is);
    std::swap(cut[1] = whole.steps[1], cut[2]);
    expect_refused(cut, kSmall, as_it_is);
    expect_refused(whole.steps, kSmall,
                   [](auto&, ArchiveMemory& written) { written.data()[1000] ^= std::byte(1); });
    // The lists of leaves come last there.
    const auto lists = [&](SteppedBuild& again, auto&) {
        again.scratch.spoil(whole.scratch.bytes() - sizeof(TriangleId) * soup.triangle_count());
    };
    expect_refused(whole.steps, kSmall, lists);
    expect_refused(std::span(whole.steps).first(3), kSmall,
                   [](SteppedBuild& again, auto&) { again.scratch.spoil(0); });
}

/// Lengths tell nothing of a bit in a box or in a plane, and a count that grew would ask for memory
/// that nobody has.
TEST_F(StreamedBuild, RefusesStepsOfWhichAnyByteHasChangedOrIsMissing) {
    const Soup soup = test::closed_grid(25);
    SteppedBuild whole{soup};
    StepMemory keeper;
    whole.run(keeper);
    ASSERT_GE(whole.steps.size(), 4u) << "the key, what was dealt, pairs and a cell";
    const auto expect_refused = [&](const auto& steps) {
        SteppedBuild again{soup, ScratchMemory(whole.scratch)};
        StepMemory found(steps, whole.saved.bytes());
        try {
            again.run(found);
            ADD_FAILURE() << "the step was believed";
        } catch (const Failure& failure) {
            EXPECT_EQ(failure.code, OVC_ERROR_UNREADABLE) << failure.message;
        } catch (const std::exception& thrown) {
            ADD_FAILURE() << thrown.what();
        }
    };
    auto steps = whole.steps;
    for (size_t step = 0; step < steps.size(); ++step)
        for (size_t at = 0; at < steps[step].size(); ++at) {
            SCOPED_TRACE(testing::Message() << "byte " << at << " of step " << step);
            steps[step][at] ^= std::byte(1u << at % 8);
            expect_refused(steps);
            steps[step][at] = whole.steps[step][at];
        }
    for (size_t step = 0; step < steps.size(); ++step)
        for (const size_t size : {size_t(0), size_t(7), steps[step].size() - 1}) {
            SCOPED_TRACE(testing::Message() << size << " bytes of step " << step);
            steps[step].resize(size);
            expect_refused(steps);
            steps[step] = whole.steps[step];
        }
}

} // namespace
} // namespace ovc
