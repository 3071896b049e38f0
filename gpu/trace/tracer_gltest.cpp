// SPDX-License-Identifier: Apache-2.0
// Tests the kernel alone: its certain answers are true, and it flags what it cannot decide.
#include "gpu/trace/tracer.h"

#include "gpu/gl/test_gl.h"
#include "kdtree/test_soups.h"
#include "shaders/layout.h"

#include <algorithm>
#include <list>
#include <numbers>
#include <numeric>

namespace ovc {
namespace {

/// A fixture with one leaf of a soup, and a tracer over it.
class KernelGl : public test::OnGl {
protected:
    void TearDown() override {
        if (gl)
            gl->run([&](GlState&) { tracer.reset(); });
    }

    void load(const Soup& soup, LoosePairs loose = LoosePairs{}, bool compute = false) {
        const PassOptions options{.variants = default_variants(gl->info(), compute)};
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        gl->run([&](GlState&) { tracer.reset(); });
        level1 = partition(soup, ids, bounds, 1u << 30);
        ASSERT_EQ(level1.leaves.size(), 1u);
        share_frame(level1);
        numbers = Numbering(soup);
        pages = {build_page(soup, numbers, level1.leaves[0], nullptr, loose)};
        top = build_top_level(pages, 1);
        const Result<MemoryPlan> plan = plan_memory(64u << 20, gl->info());
        ASSERT_TRUE(plan);
        MemoryPlan shared = *plan;
        DeviceInfo device = gl->info();
        device.takes_host_pages = device.takes_host_pages && with_host_pages;
        gl->run([&](GlState& state) {
            auto created =
                Tracer::create(shared, options, device, state.kernels, level1.bounds, pages, top);
            ASSERT_TRUE(created) << created.error().message;
            tracer = std::move(*created);
            EXPECT_EQ(tracer->bring(std::vector<uint32_t>{0}).bytes, pages[0].bytes());
        });
    }

    /// The answers refer to the fixture.
    std::vector<Answer> trace(std::span<const Ray> rays, bool any_hit = false) {
        std::vector<RayState> states(rays.size());
        for (size_t i = 0; i < rays.size(); ++i)
            states[i] = {.ray = rays[i], .asks = any_hit ? OVC_RAY_ANY_HIT : 0};
        std::vector<Answer> answers(rays.size());
        gl->run([&](GlState&) {
            SentRays rays_sent = send(tracer->form(), states);
            const auto was_sent = rays_sent.bytes();
            const std::vector<std::byte> before(was_sent.begin(), was_sent.end());
            Answers& all = traced.emplace_back();
            const Result<Done> done = tracer->trace(rays_sent, all);
            ASSERT_TRUE(done) << done.error().message;
            for (size_t i = 0; i < answers.size(); ++i)
                answers[i] = all[i];
            EXPECT_GT(tracer->kernel_seconds(), 0);
            rays_sent.unpart();
            EXPECT_TRUE(std::ranges::equal(rays_sent.bytes(), before)) << "a kernel wrote to rays";
        });
        return answers;
    }

    void expect_truth(const Soup& soup, std::span<const Ray> rays);
    /// Returns the t of the ray before which a flagged answer says that it hits nothing.
    double begin_of(const Ray& ray, const Answer& answer) const {
        LocalTime time;
        local_ray(*tracer->form().scene, ray, OVC_NO_TRIANGLE, false, time);
        return time.begin_of(answer.first_t());
    }

    bool with_host_pages = true; // if the device takes them
    std::unique_ptr<Tracer> tracer;
    std::list<Answers> traced;
    Level1 level1;
    Numbering numbers;
    std::vector<Page> pages;
    TopLevel top;
};

const Leaf& leaf_of(const Level1& level1) {
    return level1.leaves[0];
}

/// Returns a ray from within the leaf's box in any direction.
Ray random_ray(test::Random& random, const Leaf& leaf) {
    const dvec3 half = leaf.box.extent() * 0.5;
    return {leaf.box.center() + random.point(-1, 1) * half, 0, random.point(-1, 1)};
}

bool is_certain(const Answer& answer) {
    return answer.prim != OVC_FLAGGED && !answer.has_further();
}

/// Checks that every certain answer is what brute force finds.
void KernelGl::expect_truth(const Soup& soup, std::span<const Ray> rays) {
    const Leaf& leaf = leaf_of(level1);
    const auto nearest = trace(rays);
    const auto any = trace(rays, /* any_hit= */ true);
    for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = test::brute_force(soup, leaf.triangles, rays[i]);
        if (is_certain(nearest[i])) {
            const bool hit = nearest[i].prim != OVC_MISS;
            // A leaf promises nothing beyond its box.
            const bool inside = !expected.is_hit() || leaf.cell.contains(rays[i].at(expected.t));
            if (!inside)
                continue;
            ASSERT_EQ(hit, expected.is_hit()) << "ray " << i;
            if (hit) {
                ASSERT_EQ(numbers.id(nearest[i].prim), expected.id) << "ray " << i;
            }
        }
        if (nearest[i].prim == OVC_FLAGGED) {
            ASSERT_LE(begin_of(rays[i], nearest[i]), expected.t) << "ray " << i;
        }
        if (is_certain(any[i])) {
            ASSERT_EQ(any[i].prim != OVC_MISS, expected.is_hit()) << "ray " << i;
        }
    }
}

// A GPU has buffers of the driver only; a software renderer may use the process's pages.
TEST_F(KernelGl, BuffersOfTheDriverAndOfTheProcessAnswerAlike) {
    const Soup soup = test::random_soup(6, 3000, 0.1);
    for (const bool compute : {false, true}) {
        std::array<std::vector<uint32_t>, 2> prims;
        for (const bool host_pages : {false, true}) {
            with_host_pages = host_pages;
            load(soup, {}, compute);
            test::Random random(8);
            std::vector<Ray> rays;
            for (int i = 0; i < 2000; ++i)
                rays.push_back(random_ray(random, leaf_of(level1)));
            for (const Answer& answer : trace(rays))
                prims[host_pages].push_back(answer.prim);
        }
        EXPECT_EQ(prims[0], prims[1]) << "compute " << compute;
        EXPECT_GT(std::ranges::count_if(prims[0], [](uint32_t p) { return p != OVC_MISS; }), 500);
    }
}

TEST_F(KernelGl, ABufferThatTheSystemHasNoPagesForIsRefused) {
    if (!gl->info().takes_host_pages)
        GTEST_SKIP() << "buffers are the driver's";
    gl->run([&](GlState&) {
        Ledger ledger;
        ledger.budget = ~uint64_t(0);
        ledger.takes_host_pages = true;
        const gl::Buffer some(ledger, 4096, "some");
        EXPECT_FALSE(ledger.refused);
        const gl::Buffer much(ledger, uint64_t(1) << 60, "much");
        EXPECT_TRUE(ledger.refused);
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    });
}

TEST_F(KernelGl, WhatItCallsCertainIsTrue) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        if (soup.triangle_count() == 0)
            continue;
        SCOPED_TRACE(name);
        for (const LoosePairs loose : {LoosePairs{}, LoosePairs{true}}) {
            load(soup, loose);
            test::Random random(4);
            std::vector<Ray> rays;
            for (int i = 0; i < 2000; ++i)
                rays.push_back(random_ray(random, leaf_of(level1)));
            expect_truth(soup, rays);
        }
    }
}

/// The rays go past sides of triangles, some roundings to either side. They would show it if the
/// bound did not hold for corners in steps of 2^-23.
TEST_F(KernelGl, WhatItCallsCertainIsTrueAtSidesOfLoosePairs) {
    const Soup soup = test::random_soup(11, 1500, 0.3);
    load(soup, LoosePairs{true});
    ASSERT_TRUE(pages[0].has_loose_pairs());
    test::Random random(12);
    const double rounding = 0x1p-24 / leaf_of(level1).frame.scale;
    std::vector<Ray> rays;
    for (const TriangleId id : leaf_of(level1).triangles)
        for (int k = 0; k < 4; ++k) {
            const Triangle t = soup.triangle(id);
            const double share = 0.5 + 0.5 * random.point(-1, 1).x;
            const dvec3 on_side = t[0] + share * (t[1] - t[0]);
            const dvec3 from = on_side + 0.3 * random.point(-1, 1);
            const dvec3 to = on_side + 20 * rounding * random.point(-1, 1);
            rays.push_back({from, 0, to - from});
        }
    expect_truth(soup, rays);
}

/// The rays begin or end some roundings before or behind a triangle. From a few hundred roundings
/// on, the kernel decides by itself.
TEST_F(KernelGl, WhatItCallsCertainIsTrueAtTheEndsOfRays) {
    const Soup soup = test::random_soup(13, 1500, 0.3);
    test::Random random(14);
    for (const LoosePairs loose : {LoosePairs{}, LoosePairs{true}}) {
        load(soup, loose);
        const double rounding = 0x1p-24 / leaf_of(level1).frame.scale;
        for (const double roundings : {3.0, 30.0, 3000.0}) {
            std::vector<Ray> rays;
            for (const TriangleId id : leaf_of(level1).triangles) {
                const Triangle t = soup.triangle(id);
                const dvec3 inside = (t[0] + t[1] + t[2]) / 3.0;
                const dvec3 dir = glm::normalize(random.point(-1, 1));
                const double off = roundings * rounding * random.point(-1, 1).x;
                rays.push_back({inside + off * dir, 0, dir});
                rays.push_back({inside - 0.2 * dir, 0, dir, 0.2 + off});
            }
            expect_truth(soup, rays);
            const auto answers = trace(rays, /* any_hit= */ true);
            const auto certain = std::count_if(answers.begin(), answers.end(), is_certain);
            EXPECT_GT(certain, ptrdiff_t(rays.size() * (roundings < 1000 ? 1 : 9) / 10))
                << roundings;
        }
    }
}

TEST_F(KernelGl, FlagsRaysAtSharedEdgesAndVertices) {
    const Soup soup = test::closed_grid(16);
    load(soup);
    std::vector<Ray> rays;
    for (const TriangleId id : leaf_of(level1).triangles)
        rays.push_back({soup.triangle(id)[0] - dvec3(0, 0, 0.25), 0, dvec3(0, 0, 1)});
    for (const Answer& answer : trace(rays))
        EXPECT_EQ(answer.prim, OVC_FLAGGED);
}

/// Returns `count` triangles that meet in the corner 0 of each.
Soup fan(int count) {
    const auto rim = [&](int i) {
        const double angle = 2 * std::numbers::pi * (i % count) / count;
        return vec3(std::cos(angle), std::sin(angle), 0.1 * (i % count % 3));
    };
    std::vector<vec3> corners;
    for (int i = 0; i < count; ++i)
        for (const vec3& corner : {vec3(0), rim(i), rim(i + 1)})
            corners.push_back(corner);
    return test::one_chunk(std::move(corners));
}

TEST_F(KernelGl, NamesUpToEightTrianglesAtAVertex) {
    for (const int count : {3, 6, 8, 9}) {
        SCOPED_TRACE(testing::Message() << count << " triangles");
        const Soup soup = fan(count);
        load(soup, {}, /* compute= */ true);
        // Different directions, so that the rays of a packet name different numbers of triangles.
        std::vector<Ray> rays;
        test::Random random(15);
        for (int i = 0; i < 1000; ++i) {
            const dvec3 dir = random.point(-1, 1) + dvec3(0, 0, i % 2 ? 3 : -3);
            const dvec3 off = i % 3 == 0 ? dvec3(0.2, 0.1, 0) : dvec3(0);
            rays.push_back({off - dir, 0, dir});
        }
        const std::vector<Answer> answers = trace(rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            if (i % 3 == 0)
                continue;
            const Answer& answer = answers[i];
            ASSERT_EQ(answer.prim == OVC_FLAGGED, count > OVC_MAX_NAMES) << "ray " << i;
            if (count > OVC_MAX_NAMES)
                continue;
            std::vector<uint32_t> names(answer.further().begin(), answer.further().end());
            std::ranges::sort(names);
            std::vector<uint32_t> all(static_cast<size_t>(count));
            std::iota(all.begin(), all.end(), 0u);
            EXPECT_EQ(names, all) << "ray " << i;
        }
    }
}

TEST_F(KernelGl, TellsWhereTheCandidatesOfAFlaggedRayBegin) {
    for (const bool compute : {false, true}) {
        const Soup soup = compute ? fan(12) : test::closed_grid(16);
        load(soup, {}, compute);
        std::vector<Ray> rays;
        for (const TriangleId id : leaf_of(level1).triangles)
            rays.push_back({soup.triangle(id)[0] - dvec3(0, 0, 2), 0, dvec3(0, 0, 0.5)});
        const std::vector<Answer> answers = trace(rays);
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(answers[i].prim, OVC_FLAGGED);
            const double t = test::brute_force(soup, leaf_of(level1).triangles, rays[i]).t;
            EXPECT_LE(begin_of(rays[i], answers[i]), t) << "ray " << i;
            EXPECT_GT(begin_of(rays[i], answers[i]), t - 0.35) << "ray " << i;
        }
    }
}

TEST_F(KernelGl, NamesBothTrianglesAtASharedEdge) {
    const Soup soup = test::closed_grid(16);
    load(soup);
    std::vector<Ray> rays;
    for (const TriangleId id : leaf_of(level1).triangles) {
        const Triangle t = soup.triangle(id);
        rays.push_back({0.5 * (t[0] + t[1]) - dvec3(0, 0, 0.01), 0, dvec3(0, 0, 1), 0.02});
    }
    const auto answers = trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        const auto candidates = answers[i].further();
        EXPECT_FALSE(is_certain(answers[i]));
        if (answers[i].prim != OVC_FLAGGED) {
            EXPECT_TRUE(candidates[0] == i || candidates[1] == i || answers[i].prim == i)
                << "ray " << i;
        }
    }
}

TEST_F(KernelGl, AnEndBeforeTheBeginningIsNoRay) {
    load(test::closed_grid(8));
    const std::vector<Ray> rays(3000, Ray{dvec3(0, 0, -4), 0, dvec3(0, 0, 1), -1});
    for (const Answer& answer : trace(rays))
        EXPECT_EQ(answer.prim, OVC_MISS);
}

/// Lanes that take rays in turn share the rounds that a software renderer allows. Thousands for
/// each ray are too many, so the pass is made again without shares.
TEST_F(KernelGl, RaysOfThousandsOfRoundsAreAnsweredByTheKernel) {
    constexpr int kLayers = 4000;
    std::vector<vec3> corners;
    for (int i = 0; i < kLayers; ++i)
        for (const vec3& corner : {vec3(0, 0, i), vec3(kLayers, 0, i), vec3(0, kLayers, i)})
            corners.push_back(corner / float(kLayers));
    load(test::one_chunk(std::move(corners)), {}, /* compute= */ true);
    // Rays 0 to 8191 go through all boxes and past all triangles, up and down in turn; the others
    // go past everything.
    std::vector<Ray> rays(40000, Ray{dvec3(5, 5, 0), 0, dvec3(1, 0, 0)});
    for (size_t i = 0; i < 8192; ++i)
        rays[i] = {dvec3(0.9, 0.9, i % 2 ? 2 : -1), 0, dvec3(0, 0, i % 2 ? -1 : 1)};
    const std::vector<Answer> answers = trace(rays);
    EXPECT_TRUE(std::all_of(answers.begin(), answers.end(), [](const Answer& answer) {
        return answer.prim == OVC_MISS && is_certain(answer);
    }));
}

} // namespace
} // namespace ovc
