// SPDX-License-Identifier: Apache-2.0
// The rule of equal answers: whatever the leaf size, the budget and the batch, two-level answers
// bit for bit what testing every triangle in double answers.
#include "plugin/two_level/test_two_level.h"

#include "core/text/format_text.h"
#include "gpu/gl/gl.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace ovc {
namespace {

using test::ok;
using test::Spawner;

struct Variant {
    std::string name;
    TwoLevelOptions options;
};

/// Lets the driver refuse the next so many requests for memory to upload through.
class RefusedUploads {
public:
    explicit RefusedUploads(int count) {
        left_ = count;
        real_ = std::exchange(epoxy_glMapNamedBufferRange, refuse);
    }
    ~RefusedUploads() { epoxy_glMapNamedBufferRange = real_; }
    RefusedUploads(const RefusedUploads&) = delete;

    int left() const { return left_; }

private:
    static void* EPOXY_CALLSPEC refuse(GLuint buffer, GLintptr offset, GLsizeiptr bytes,
                                       GLbitfield access) {
        if (left_ <= 0)
            return real_(buffer, offset, bytes, access);
        --left_;
        glEnable(GL_NONE); // GL has an error from now on
        return nullptr;
    }

    static inline std::atomic<int> left_{0};
    static inline PFNGLMAPNAMEDBUFFERRANGEPROC real_ = nullptr;
};

std::vector<Variant> variants() {
    return {{"ten leaves", {}},
            {"one leaf", {.leaf_triangles = 1u << 30}},
            {"leaves of 40", {.leaf_triangles = 40}},
            {"compute", {.leaf_triangles = 500, .compute = true}},
            {"smallest budget", {.budget_bytes = 96u << 10, .leaf_triangles = 100}},
            {"beside", {.budget_bytes = 96u << 10, .leaf_triangles = 100, .beside = true}}};
}

TEST_F(TwoLevelGl, EqualsBruteForceBitForBit) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 33, 1500);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(soup_name + ", " + name);
            const auto structure = build(soup, options);
            ASSERT_TRUE(structure);
            test::expect_answers(*structure, rays, expected);
            const ovc_statistics& s = structure->statistics();
            EXPECT_LE(s.gpu_peak_bytes, structure->plan().budget_bytes);
            EXPECT_EQ(s.nearest_rays, rays.size());
        }
    }
}

TEST_F(TwoLevelGl, CountsARayOnceByWhatItAsksFor) {
    const Soup soup = test::random_soup(9, 500, 0.3);
    const auto rays = test::rays_from_outside(3, 1000);
    const std::vector<uint32_t> masks(rays.size(), 1);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    std::vector<uint8_t> occluded(rays.size());
    Exclusions without;
    without.sieves.masks = masks;
    ASSERT_TRUE(ok(structure->occluded(rays, without, occluded)));
    EXPECT_EQ(structure->statistics().occlusion_rays, rays.size());
    EXPECT_EQ(structure->statistics().nearest_rays, 0u);
    std::vector<Hit> hits(3 * rays.size());
    std::vector<uint64_t> counts(rays.size());
    ASSERT_TRUE(ok(structure->all_hits(rays, {}, {3, hits, counts})));
    EXPECT_EQ(structure->statistics().nearest_rays, rays.size());
}

/// Every coordinate of these rays is exact at the corner, and none is along the way.
TEST_F(TwoLevelGl, ARayFromFarAwayMeetsTheCornerOfTheScene) {
    const Soup soup = test::one_chunk({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)});
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    test::Random random(1);
    std::vector<Ray> rays(3000);
    for (Ray& ray : rays) {
        ray.dir = glm::floor(random.point(1, 50)) * dvec3(1, 1, -1);
        ray.org = -std::floor(random(1e8, 1e9)) * ray.dir;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        EXPECT_TRUE(hits[i].is_hit()) << "ray " << i;
}

TEST_F(TwoLevelGl, AFloorLiesInALeafOfItsOwn) {
    const Soup soup = test::grid_on_floor(24);
    const auto unpleasant = test::unpleasant_rays(soup, 34, 3000);
    const std::vector<Hit> expected = test::brute_force(soup, unpleasant);
    const auto rays = test::rays_from_outside(35, 3000);
    const std::vector<Hit> ordinary = test::brute_force(soup, rays);
    for (const uint64_t budget : {0u, 112u << 10})
        for (const bool certify : {true, false}) {
            const auto structure =
                build(soup, {.budget_bytes = budget, .leaf_triangles = 60, .certify = certify});
            ASSERT_TRUE(structure);
            EXPECT_EQ(structure->scene().level1.far_leaves, 1u);
            if (certify) {
                test::expect_answers(*structure, unpleasant, expected);
                continue;
            }
            std::vector<Hit> hits(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            size_t other = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                other += hits[i].id != ordinary[i].id;
            EXPECT_LT(other, rays.size() / 500);
        }
}

/// The pool holds all pages, or all but the top-level tree beside them, or all but one.
TEST_F(TwoLevelGl, AnyBudgetNearThatOfAllPagesAnswersAlike) {
    const Soup soup = test::closed_grid(60);
    const std::vector<Ray> rays = test::rays_from_outside(13, 4000);
    const auto all = build(soup, {.leaf_triangles = 100});
    ASSERT_TRUE(all);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(all->intersect(rays, {}, expected)));
    const uint64_t pages = all->scene().level2_bytes();
    size_t waited = 0, resident = 0; // structures whose rays waited for pages, or did not
    for (uint64_t pool = pages - (16 << 10); pool < pages + (128 << 10); pool += 8 << 10) {
        const uint64_t budget = pool / 7 * 8; // an eighth is for rays
        const auto structure = build(soup, {.budget_bytes = budget, .leaf_triangles = 100});
        ASSERT_TRUE(structure);
        for (int call = 0; call < 3; ++call) { // pages move in the first
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            for (size_t i = 0; i < rays.size(); ++i)
                ASSERT_TRUE(test::same(hits[i], expected[i])) << "ray " << i << ", pool " << pool;
        }
        const ovc_statistics told = structure->report();
        ++(told.queues + told.stragglers > 0 ? waited : resident);
    }
    EXPECT_GT(waited, 0u);
    EXPECT_GT(resident, 0u);
}

/// Keeps the share of the rays that it was told last.
struct Listens final : TraceWatch {
    double told = 0;
    bool goes_on(double done) override {
        told = done;
        return true;
    }
};

/// There are so many rays that they come in several parts, one of which has no ray for the kernel.
/// So many that 32 bits do not number them all are as those of which 17 bits do not.
TEST_F(TwoLevelGl, ManyRaysAreAnsweredAsFewAre) {
    const Soup soup = test::closed_grid(60);
    std::vector<Ray> rays = test::rays_from_outside(11, 300000);
    test::Random random(12);
    for (Ray& ray : rays)
        if (random.below(5) == 0)
            ray.dir = -ray.dir; // away from the scene
    for (size_t i = 70000; i < 230000; ++i)
        rays[i].t_max = -1; // invalid
    const auto linked = build(soup, {}), numbered = build(soup, {.max_numbered_rays = 1u << 17});
    const auto moving = build(soup, {.budget_bytes = 192u << 10, .leaf_triangles = 300});
    ASSERT_TRUE(linked && numbered && moving);
    std::vector<Hit> expected(rays.size());
    ASSERT_TRUE(ok(moving->intersect(rays, {}, expected)));
    for (TwoLevel* all : {linked.get(), numbered.get()}) {
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(all->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(hits[i], expected[i])) << "ray " << i;
        EXPECT_GT(all->statistics().passes, 1u);
        EXPECT_EQ(all->statistics().pages_in, all->scene().level1.leaves.size());
        EXPECT_EQ(all->statistics().invalid_rays, 160000u);
        EXPECT_LT(all->statistics().ray_visits, 140000u);

        std::vector<uint8_t> occluded(rays.size());
        ASSERT_TRUE(ok(all->occluded(rays, {}, occluded)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(occluded[i] != 0, expected[i].is_hit()) << "ray " << i;
    }
    EXPECT_GT(moving->statistics().pages_in, moving->scene().level1.leaves.size());
    Listens watch;
    const CallWatch::Scope scope(numbered->call_watch(), &watch);
    ASSERT_TRUE(ok(numbered->intersect(rays, {}, expected)));
    EXPECT_GT(watch.told, 0.8) << "of all rays, before the last pass of the third part";
}

/// The compute kernel takes neighbours together where they go the same way, and others in turns.
TEST_F(TwoLevelGl, RaysAreAnsweredAlikeInAnyOrderAndByBothKernels) {
    const Soup soup = test::closed_grid(60);
    constexpr int kSide = 300;
    std::vector<Ray> ordered;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            ordered.push_back({dvec3(0.1, 0.2, -4), 0, dvec3(x - kSide / 2, y - kSide / 2, 200)});
    std::vector<size_t> shuffled(ordered.size());
    std::iota(shuffled.begin(), shuffled.end(), size_t(0));
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
    std::vector<Ray> rays;
    for (const size_t i : shuffled)
        rays.push_back(ordered[i]);

    const auto fragment = build(soup, {.compute = false});
    const auto compute = build(soup, {.compute = true});
    ASSERT_TRUE(fragment && compute);
    std::vector<Hit> expected(rays.size()), together(rays.size()), in_turns(rays.size());
    ASSERT_TRUE(ok(fragment->intersect(ordered, {}, expected)));
    ASSERT_TRUE(ok(compute->intersect(ordered, {}, together)));
    ASSERT_TRUE(ok(compute->intersect(rays, {}, in_turns)));
    std::vector<uint8_t> occluded(rays.size());
    ASSERT_TRUE(ok(compute->occluded(rays, {}, occluded)));
    size_t hit = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(test::same(expected[i], together[i])) << "ray " << i;
        ASSERT_TRUE(test::same(expected[shuffled[i]], in_turns[i])) << "ray " << shuffled[i];
        ASSERT_EQ(occluded[i] != 0, in_turns[i].is_hit()) << "ray " << shuffled[i];
        hit += in_turns[i].is_hit();
    }
    EXPECT_GT(hit, rays.size() / 10);
    EXPECT_LT(hit, rays.size());
}

TEST_F(TwoLevelGl, FewOrdinaryRaysAreFlagged) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto rays = test::rays_from_outside(5, 100000);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 100);
    EXPECT_GT(structure->statistics().passes, 0u);
}

TEST_F(TwoLevelGl, TimeOfTheKernelIsPartOfThatOfPassesIsPartOfThatOfTheCall) {
    const Soup soup = test::closed_grid(100);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto rays = test::rays_from_outside(5, 100000);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_GT(structure->statistics().seconds_kernel, 0);
    EXPECT_LT(structure->statistics().seconds_kernel, structure->statistics().seconds_pass);
    EXPECT_LT(structure->statistics().seconds_pass, structure->statistics().seconds_trace);
}

TEST_F(TwoLevelGl, RaysThatStartOnASurfaceAreNotFlaggedForIt) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto [rays, skip] = test::RaysOnTriangles(soup, 1);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 50);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (size_t i = 0; i < rays.size(); i += 97)
        EXPECT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i], skip[i])));
}

/// The triangles of `once` in three meshes: the second has some of them twice, the third all of
/// them; each copy's corners are turned and wound in a way of its own.
Soup tripled(const Soup& once) {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const auto corners = once.chunks[0].corners();
    std::vector<vec3> meshes[3];
    for (uint32_t prim = 0; prim < once.triangle_count(); ++prim)
        for (uint32_t copy = 0; copy < 4; ++copy) {
            if (copy == 0 && prim % 3 == 0)
                continue;
            if (copy == 2 && prim % 2)
                continue;
            const int* order = kOrders[(prim + 2 * copy) % 6];
            for (int i = 0; i < 3; ++i)
                meshes[std::max(copy, 1u) - 1].push_back(corners[prim * 3 + uint32_t(order[i])]);
        }
    Soup soup;
    for (auto& mesh : meshes)
        soup.chunks.push_back(Chunk::owning(once.chunks[0].origin(), std::move(mesh)));
    return soup;
}

/// Rays that start on triangles of the soup, which they do not see, and rays that do not see a
/// triangle elsewhere on their way.
void rays_that_skip(const Soup& soup, size_t count, std::vector<Ray>& rays,
                    std::vector<TriangleId>& skip) {
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    test::Random random(19);
    for (size_t i = 0; i < count; ++i) {
        const TriangleId id = ids[random.below(ids.size())];
        const Triangle t = soup.triangle(id);
        const double u = i % 5 ? random(0, 0.5) : 0, v = i % 7 ? random(0, 0.5) : 0;
        const dvec3 at = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        const dvec3 dir = random.point(-1, 1);
        rays.push_back({i % 2 ? at : at - dir, 0, dir});
        skip.push_back(id);
    }
}

TEST_F(TwoLevelGl, DuplicatesAnswerAsBruteForceDoes) {
    const Soup single[] = {test::random_soup(2, 700, 0.05), test::closed_grid(12),
                           test::closed_grid(12, dvec3(4.5e6, 6e6, -6))};
    for (const Soup& once : single) {
        const Soup soup = tripled(once);
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        std::vector<Ray> rays = test::unpleasant_rays(soup, 35, 800);
        std::vector<TriangleId> skip(rays.size());
        rays_that_skip(soup, 1600, rays, skip);
        std::vector<Hit> expected;
        size_t met_a_duplicate = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            expected.push_back(test::brute_force(soup, ids, rays[i], skip[i]));
            met_a_duplicate += expected[i].is_hit() && skip[i].mesh != kNone &&
                               same_corners(soup.triangle(expected[i].id), soup.triangle(skip[i]));
        }
        EXPECT_GT(met_a_duplicate, 400u);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(name);
            const auto structure = build(soup, options);
            ASSERT_TRUE(structure);
            EXPECT_EQ(structure->scene().duplicates.count(), ids.size() - once.triangle_count());
            // They are not equal, because pairs depend on how triangles are numbered.
            const auto alone = double(build(once, options)->scene().level2_bytes());
            EXPECT_NEAR(double(structure->scene().level2_bytes()), alone, 0.05 * alone);
            std::vector<Hit> hits(rays.size());
            std::vector<uint8_t> shadows(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
            ASSERT_TRUE(ok(structure->occluded(rays, skip, shadows)));
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(test::same(expected[i], hits[i]))
                    << "ray " << i << ": " << test::describe(expected[i]) << " but found "
                    << test::describe(hits[i]);
                ASSERT_EQ(expected[i].is_hit(), shadows[i] != 0) << "ray " << i;
            }
        }
    }
}

TEST_F(TwoLevelGl, DuplicatesAreNotFlaggedForEachOther) {
    const Soup soup = tripled(test::closed_grid(100));
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    test::Random random(5);
    std::vector<Ray> rays(20000);
    for (Ray& ray : rays) {
        ray.org = random.point(-1, 1) + dvec3(0, 0, 4);
        ray.dir = random.point(-1, 1) - ray.org;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 100);
}

TEST_F(TwoLevelGl, FastPrecisionSeesTheDuplicateOfWhatItSkips) {
    const Soup soup = tripled(test::closed_grid(12));
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    rays_that_skip(soup, 4000, rays, skip);
    const auto structure = build(soup, {.certify = false});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
    size_t same = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = test::brute_force(soup, ids, rays[i], skip[i]);
        if (!expected.is_hit() || hits[i].id != expected.id || expected.t < 0.01)
            continue;
        ++same;
        EXPECT_NEAR(hits[i].t, expected.t, 1e-4);
        EXPECT_NEAR(hits[i].u, expected.u, 1e-2);
        EXPECT_NEAR(hits[i].v, expected.v, 1e-2);
    }
    EXPECT_GT(same, rays.size() / 3);
}

/// Triangles one behind the other along z, each with a corner on the z axis; a ray past all of them
/// at (0.9, 0.9) goes through all their boxes.
Soup stack_of_triangles(int count) {
    std::vector<vec3> corners;
    for (int i = 0; i < count; ++i)
        for (const vec3& v : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            corners.push_back(v + vec3(0, 0, float(i) / float(count)));
    return test::one_chunk(std::move(corners));
}

TEST_F(TwoLevelGl, ALoopThatTheDriverEndsIsCountedAndDecidedInDouble) {
    const Soup soup = stack_of_triangles(200'000);
    const std::vector<Ray> rays = {
        {dvec3(0, 0, -1), 0, dvec3(0, 0, 1)},        // each in doubt: ends at the first
        {dvec3(0.9, 0.9, -1), 0, dvec3(0, 0, 1)},    // each box, no triangle
        {dvec3(0.25, 0.25, 2), 0, dvec3(0, 0, -1)}}; // the first is certain
    for (const uint64_t buffer_bytes : {0, 1 << 20})
        for (const auto& [certify, compute] :
             {std::pair(true, false), {true, true}, {false, false}, {false, true}}) {
            SCOPED_TRACE(std::string(certify ? "certified" : "fast") +
                         (compute ? ", compute" : "") + (buffer_bytes ? ", many buffers" : ""));
            const auto structure = build(soup, {.leaf_triangles = buffer_bytes ? 2000u : 1u << 30,
                                                .certify = certify,
                                                .compute = compute,
                                                .buffer_bytes = buffer_bytes});
            ASSERT_TRUE(structure);
            std::vector<Hit> hits(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            EXPECT_EQ(hits[0].id, (TriangleId{0, 0}));
            EXPECT_FALSE(hits[1].is_hit());
            EXPECT_EQ(hits[2].id, (TriangleId{0, 199'999}));
            const ovc_statistics& s = structure->statistics();
            EXPECT_LE(s.capped, s.retraced);
            if (gl->info().is_software && buffer_bytes == 0) {
                EXPECT_EQ(s.capped, 1u) << "no loop was ended, or one of a ray in doubt";
            }
        }
}

/// The pool has no page then where the tracer believes that it has one.
TEST_F(TwoLevelGl, APageThatDidNotGetThereFailsOneCallAlone) {
    if (!gl->info().is_software)
        GTEST_SKIP() << "uploads go through memory that stays mapped";
    const Soup soup = test::random_soup(9, 4000, 0.2);
    const std::vector<Ray> rays = test::rays_from_outside(3, 3000);
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    const auto structure = build(soup, {.budget_bytes = 96u << 10, .leaf_triangles = 40});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, expected);
    {
        const RefusedUploads refused(2);
        std::vector<Hit> hits(rays.size());
        EXPECT_FALSE(structure->intersect(rays, {}, hits));
        EXPECT_EQ(refused.left(), 0);
    }
    test::expect_answers(*structure, rays, expected);
}

TEST_F(TwoLevelGl, AStackGrowsUntilFewRaysNeedMore) {
    const Soup soup = test::random_soup(9, 4000, 0.2);
    const std::vector<Ray> rays = test::rays_from_outside(3, 3000);
    const KernelVariant variant = *parse_variant("compute,group=64,both-sides,registers=1,images");
    const auto structure = build(soup, {.variant = VariantChoice::Given, .given_variant = variant});
    ASSERT_TRUE(structure);
    test::expect_answers(*structure, rays, test::brute_force(soup, rays));
    EXPECT_LT(structure->statistics().capped, rays.size() / 256); // most need more than one word
}

/// Rectangles that overlap in the plane z = 0, in front of a wall: level 1 cuts many thin cells
/// along that plane.
Soup overlapping_rectangles(int count) {
    test::Random random(41);
    const auto on_grid = [&](double lo, double hi) {
        return float(std::round(random(lo, hi) * 4096) / 4096);
    };
    std::vector<vec3> corners;
    const auto add_rectangle = [&](vec3 a, vec3 x, vec3 y) {
        corners.insert(corners.end(), {a, a + x, a + x + y, a, a + x + y, a + y});
    };
    for (int i = 0; i < 16; ++i)
        add_rectangle(vec3(float(i % 4) / 2 - 1, float(i / 4) / 2 - 1, -1), vec3(0.5f, 0, 0),
                      vec3(0, 0.5f, 0));
    for (int i = 0; i < count; ++i)
        add_rectangle(vec3(on_grid(-1, 0.5), on_grid(-1, 0.5), 0), vec3(on_grid(0.01, 0.5), 0, 0),
                      vec3(0, on_grid(0.01, 0.5), 0));
    return test::one_chunk(std::move(corners));
}

// Triangles in one plane are in many leaves, of one cell and of the next, and t is rounded
// differently for each triangle.
TEST_F(TwoLevelGl, TiesAcrossLeavesAndCellsGoToTheSmallerId) {
    const Soup soup = overlapping_rectangles(400);
    const KdTree tree = build_kd_tree(soup);
    test::Random random(42);
    std::vector<Ray> rays(10000);
    for (Ray& ray : rays) {
        const Triangle t = soup.triangle({0, uint32_t(random.below(soup.triangle_count()))});
        const dvec3 target = t[0] + random(0, 1) * (t[1] - t[0]);
        ray.org = dvec3(vec3(target + std::exp(random(-4, 1)) * random.point(-1, 1)));
        ray.dir = dvec3(vec3(target - ray.org));
    }
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    intersect(tree, soup, rays, {}, expected);
    const auto structure = build(soup, {.leaf_triangles = 40});
    ASSERT_TRUE(structure);
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(test::same(expected[i], hits[i]))
            << "ray " << i << ": " << test::describe(expected[i]) << " but found "
            << test::describe(hits[i]);
}

TEST_F(TwoLevelGl, KeepsToTheBudgetByMovingPages) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    const auto rays = test::unpleasant_rays(soup, 12, 30000);
    const auto structure = build(soup, {.budget_bytes = all / 4});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    const ovc_statistics& s = structure->statistics();
    EXPECT_LE(s.gpu_peak_bytes, all / 4);
    EXPECT_GT(s.pages_in, structure->scene().level1.leaves.size()) << "nothing had to move twice";
    EXPECT_GE(s.bytes_in, structure->scene().level2_bytes());
}

TEST_F(TwoLevelGl, TellsTheLeafOfAHitAndThePassesOfARay) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const auto rays = test::rays_from_outside(12, 30000);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    for (const uint64_t budget : {uint64_t(0), all / 4}) {
        const auto structure = build(soup, {.budget_bytes = budget});
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        std::vector<uint32_t> leaf(rays.size()), passes(rays.size(), 7);
        ASSERT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {leaf, passes})));
        uint64_t visits = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            visits += passes[i];
            ASSERT_EQ(hits[i].is_hit(), leaf[i] != kNone) << "ray " << i;
            if (!hits[i].is_hit())
                continue;
            const Leaf& told = structure->scene().level1.leaves[leaf[i]];
            EXPECT_TRUE(std::ranges::binary_search(told.triangles, hits[i].id)) << "ray " << i;
            EXPECT_TRUE(told.cell.contains(rays[i].at(hits[i].t))) << "ray " << i;
            EXPECT_GE(passes[i], 1u) << "ray " << i;
        }
        EXPECT_EQ(visits, structure->statistics().ray_visits);
        EXPECT_EQ(structure->statistics().bytes_in > all * 11 / 10, budget > 0) << "moved again";
        const uint32_t most = *std::ranges::max_element(passes);
        EXPECT_EQ(most == 1, budget == 0) << most << " passes";
    }
}

TEST_F(TwoLevelGl, TellsWhichRaysTheKernelWasNotCertainOf) {
    const Soup soup = test::random_soup(8, 3000, 0.01);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    auto rays = test::rays_from_outside(12, soup.triangle_count());
    for (uint32_t i = 0; i < rays.size(); i += 2) // at corners, where a hit is never certain
        rays[i].dir = soup.triangle({0, i})[0] - rays[i].org;
    std::vector<Hit> hits(rays.size());
    std::vector<uint32_t> flagged(rays.size(), 7);
    ASSERT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {{}, {}, flagged})));
    uint64_t at_corners = 0, elsewhere = 0;
    for (size_t i = 0; i < rays.size(); ++i)
        (i % 2 == 0 ? at_corners : elsewhere) += flagged[i];
    EXPECT_GT(at_corners, rays.size() / 4) << "but for those that something hides";
    EXPECT_LT(elsewhere, rays.size() / 50);
    EXPECT_EQ(at_corners + elsewhere, structure->statistics().flagged) << "once a ray, in one pass";
}

TEST_F(TwoLevelGl, TellsThePagesThatRaysWentThrough) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const auto aimed = test::rays_from_outside(12, 5000);
    const std::vector<Ray> few(aimed.begin(), aimed.begin() + 3);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    for (const bool compute : {false, true})
        for (const uint64_t budget : {uint64_t(0), all / 4}) {
            const auto structure = build(
                soup,
                {.budget_bytes = budget, .leaves = 60, .compute = compute, .tell_active = true});
            ASSERT_TRUE(structure);
            const auto trace = [&](std::span<const Ray> rays) {
                std::vector<Hit> hits(rays.size());
                std::vector<uint32_t> leaf(rays.size());
                EXPECT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {leaf, {}})));
                std::ranges::sort(leaf);
                const auto end = std::ranges::unique(leaf).begin();
                return size_t(end - leaf.begin()) - (leaf.back() == kNone); // leaves that were hit
            };
            const size_t hit = trace(aimed);
            const Result<ovc_active> active = structure->take_active();
            ASSERT_TRUE(active) << active.error().message;
            EXPECT_GE(active->pages, hit);
            EXPECT_LE(active->bytes, structure->scene().level2_bytes());
            EXPECT_EQ(active->pages, active->new_pages);
            // Fewer rays: no page is new.
            trace(few);
            const Result<ovc_active> less = structure->take_active();
            ASSERT_TRUE(less);
            EXPECT_GT(less->pages, 0u);
            EXPECT_LT(less->pages, active->pages);
            EXPECT_EQ(less->new_pages, 0u);
            EXPECT_EQ(structure->take_active()->pages, 0u) << "no rays since";
            EXPECT_EQ(structure->statistics().queues > 0, budget > 0);
            EXPECT_GE(structure->statistics().queued_rays, structure->statistics().longest_queue);
        }
    EXPECT_FALSE(build(soup, {})->take_active());
}

TEST_F(TwoLevelGl, FastPrecisionIsCloseAndFlagsNothing) {
    const Soup soup = test::closed_grid(100);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (const auto& [compute, budget] :
         {std::pair(false, 0u), std::pair(true, 0u), std::pair(false, 192u << 10),
          std::pair(true, 192u << 10)}) {
        const auto structure = build(soup, {.budget_bytes = budget,
                                            .leaf_triangles = budget > 0 ? 300u : 0u,
                                            .certify = false,
                                            .compute = compute});
        ASSERT_TRUE(structure);
        test::Random random(15);
        std::vector<Ray> rays(5000);
        for (Ray& ray : rays) {
            ray.org = random.point(-1, 1) + dvec3(0, 0, 4);
            ray.dir = random.point(-1, 1) - ray.org;
        }
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        size_t other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, ids, rays[i]);
            if (hits[i].id != expected.id) {
                ++other;
                continue;
            }
            if (!expected.is_hit())
                continue;
            EXPECT_NEAR(hits[i].t, expected.t, 1e-5);
            EXPECT_NEAR(hits[i].u, expected.u, 1e-2);
            EXPECT_NEAR(hits[i].v, expected.v, 1e-2);
        }
        EXPECT_LT(other, rays.size() / 500);
        EXPECT_EQ(structure->statistics().flagged, 0u);
        EXPECT_EQ(structure->statistics().queues > 0, budget > 0);
        std::vector<uint8_t> occluded(rays.size());
        ASSERT_TRUE(ok(structure->occluded(rays, {}, occluded)));
        for (size_t i = 0; i < rays.size(); ++i)
            EXPECT_EQ(occluded[i] != 0, hits[i].is_hit()) << "ray " << i;
    }
}

TEST_F(TwoLevelGl, FastPrecisionSeesTheFloorThatEndsTheScene) {
    std::vector<vec3> corners;
    for (int i = 0; i < 400; ++i)
        for (const vec3& v : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 0, 0),
                              vec3(1, 1, 0), vec3(0, 1, 0)})
            corners.push_back(v + vec3(float(i % 20), float(i / 20), 0));
    corners.insert(corners.end(), {vec3(0, 0, 7), vec3(1, 0, 7), vec3(0, 1, 7)});
    const Soup soup = test::one_chunk(std::move(corners));
    const auto structure = build(soup, {.certify = false});
    ASSERT_TRUE(structure);
    test::Random random(25);
    std::vector<Ray> rays(5000);
    for (Ray& ray : rays) {
        ray.org = dvec3(random(2, 18), random(2, 18), 5);
        ray.dir = dvec3(random(2, 18), random(2, 18), 0) - ray.org;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].is_hit()) << "ray " << i;
        ASSERT_NEAR(hits[i].t, 1, 1e-5) << "ray " << i;
    }
}

/// Expects that what the ray was answered with is a hit of the triangle that it names, to the last
/// bit, and not of `skip`.
void expect_true(const Soup& soup, const Ray& ray, const Hit& hit, TriangleId skip) {
    if (!hit.is_hit())
        return;
    EXPECT_FALSE(hit.id == skip);
    const Hit exact = test::brute_force(soup, {hit.id}, ray);
    EXPECT_EQ(exact.id, hit.id);
    EXPECT_EQ(exact.t, hit.t);
    EXPECT_EQ(exact.u, hit.u);
    EXPECT_EQ(exact.v, hit.v);
}

TEST_F(TwoLevelGl, FastHitsBehindOneAnotherAreTrueAndComeOnce) {
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const bool compute : {false, true}) {
            SCOPED_TRACE(name + (compute ? ", compute" : ", fragment"));
            const auto rays = test::unpleasant_rays(soup, 51, 300);
            const auto structure =
                build(soup, {.leaf_triangles = 40, .certify = false, .compute = compute});
            ASSERT_TRUE(structure);
            std::vector<Hit> hits(rays.size()), after(rays.size(), kBeforeAll);
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            std::vector<TriangleId> skip(rays.size());
            for (size_t i = 0; i < rays.size(); i += 2)
                skip[i] = hits[i].id;
            std::vector<std::set<TriangleId>> met(rays.size());
            size_t left = 1;
            for (size_t step = 0; left > 0; ++step) {
                ASSERT_LE(step, soup.triangle_count());
                ASSERT_TRUE(ok(structure->intersect(rays, Exclusions(skip, after), hits)));
                left = 0;
                for (size_t i = 0; i < rays.size(); ++i) {
                    expect_true(soup, rays[i], hits[i], skip[i]);
                    if (!hits[i].is_hit())
                        continue;
                    ++left;
                    EXPECT_GE(hits[i].t, after[i].t);
                    EXPECT_TRUE(met[i].insert(hits[i].id).second) << "ray " << i;
                }
                after = hits;
            }
        }
}

TEST_F(TwoLevelGl, FastRaysBehindMaskedHitsDoNotSeeWhatTheySkip) {
    Soup soup = test::random_soup(52, 400, 0.3);
    Soup other = test::random_soup(53, 400, 0.3);
    soup.chunks.push_back(std::move(other.chunks.front()));
    soup.chunks[0].set_mask(1);
    soup.chunks[1].set_mask(2);
    const auto rays = test::rays_from_outside(54, 3000);
    const std::vector<uint32_t> masks(rays.size(), 2);
    const auto structure = build(soup, {.leaf_triangles = 40, .certify = false});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    Exclusions without;
    without.sieves.masks = masks;
    ASSERT_TRUE(ok(structure->intersect(rays, without, hits)));
    std::vector<TriangleId> skip;
    for (const Hit& hit : hits)
        skip.push_back(hit.id);
    without.skip = skip;
    ASSERT_TRUE(ok(structure->intersect(rays, without, hits)));
    size_t second = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        expect_true(soup, rays[i], hits[i], skip[i]);
        second += hits[i].is_hit();
        EXPECT_TRUE(!hits[i].is_hit() || hits[i].id.mesh == 1);
    }
    EXPECT_GT(second, 100u);
}

TEST_F(TwoLevelGl, NamesTheSmallestBudgetThatWorks) {
    const Soup soup = test::random_soup(8, 100, 0.01);
    const auto refused = TwoLevel::build(soup, *gl, {.budget_bytes = 1024}, {});
    ASSERT_FALSE(refused);
    const uint64_t passes = gl->info().passes_in_flight; // with rays and answers of their own
    EXPECT_EQ(refused.error().message,
              format_text("a GPU budget of 1024 bytes is too small: the smallest that works is {} "
                          "bytes ({} for rays and answers, 16384 for a page)",
                          passes * 24580 + 16384, passes * 24580));
    EXPECT_TRUE(TwoLevel::build(soup, *gl, {.budget_bytes = 81920}, {}));
}

TEST_F(TwoLevelGl, AStreamAnswersWhatBatchesAnswer) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 71, 1500);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(soup_name + ", " + name);
            const auto structure = build(soup, options);
            std::vector<Hit> expected(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, expected)));
            std::vector<Ray> second;
            std::vector<TriangleId> skip;
            std::vector<size_t> parents;
            for (size_t i = 0; i < rays.size(); ++i)
                if (expected[i].is_hit()) {
                    second.push_back(Spawner::from_hit(rays[i], expected[i]));
                    skip.push_back(expected[i].id);
                    parents.push_back(i);
                }
            std::vector<uint8_t> occluded(second.size());
            ASSERT_TRUE(ok(structure->occluded(second, skip, occluded)));

            Spawner host(rays, 400);
            ASSERT_TRUE(ok(structure->stream(host)));
            EXPECT_EQ(host.answers, rays.size());
            size_t differing = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                differing += !test::same(host.hits_of[i], expected[i]);
            EXPECT_EQ(differing, 0u);
            differing = 0;
            for (size_t j = 0; j < parents.size(); ++j)
                differing += host.blocked[parents[j]] != occluded[j];
            EXPECT_EQ(differing, 0u);
        }
    }
}

TEST_F(TwoLevelGl, AStreamThatIsStoppedSaysSoAndTheStructureGoesOn) {
    const Soup soup = test::closed_grid(24);
    const auto rays = test::unpleasant_rays(soup, 5, 1000);
    const auto structure = build(soup, {.leaf_triangles = 100});
    Spawner host(rays, 100);
    host.stop_after = 150;
    const Result<Done> stopped = structure->stream(host);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::Cancelled);
    Spawner again(rays, 1000);
    EXPECT_TRUE(ok(structure->stream(again)));
    EXPECT_EQ(again.answers, rays.size());
}

} // namespace
} // namespace ovc
