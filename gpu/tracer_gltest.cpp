// SPDX-License-Identifier: Apache-2.0
// The kernel alone: what it calls certain is true, what it cannot know it flags.
#include "gpu/tracer.h"

#include "gpu/gl_thread.h"
#include "kdtree/test_soups.h"
#include "shaders/layout.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// One leaf of a soup, and a tracer on it.
class KernelGl : public testing::Test {
protected:
    void SetUp() override {
        Result<std::unique_ptr<GlThread>> started = GlThread::start("", {});
        if (!started)
            GTEST_SKIP() << started.error().message;
        gl = std::move(*started);
    }
    void TearDown() override {
        if (gl)
            gl->run([&](GlState&) { tracer.reset(); });
    }

    void load(const Soup& soup) {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        level1 = partition(soup, ids, bounds, 1u << 30);
        ASSERT_EQ(level1.leaves.size(), 1u);
        page = build_page(soup, level1.leaves[0]);
        const Result<MemoryPlan> plan = plan_memory(64u << 20, gl->info());
        ASSERT_TRUE(plan);
        gl->run([&](GlState& state) {
            auto created = Tracer::create(*plan, gl->info(), state.kernels, 1);
            ASSERT_TRUE(created) << created.error().message;
            tracer = std::move(*created);
        });
    }

    std::vector<LocalAnswer> trace(std::vector<LocalRay> rays, const PassOptions& options) {
        const size_t count = rays.size();
        rays.resize(Tracer::row_padded(count),
                    LocalRay{vec3(0), -1, vec3(0, 0, 1), OVC_NO_TRIANGLE});
        std::vector<LocalAnswer> answers(rays.size());
        gl->run([&](GlState&) {
            const auto pass = tracer->pass(0, page, options, std::span(rays).first(count),
                                           std::span(answers).first(count));
            ASSERT_TRUE(pass) << pass.error().message;
        });
        answers.resize(count);
        return answers;
    }

    std::unique_ptr<GlThread> gl;
    std::unique_ptr<Tracer> tracer;
    Level1 level1;
    Page page;
};

const Leaf& leaf_of(const Level1& level1) {
    return level1.leaves[0];
}

/// Rays in the leaf's frame, exact in float: the world's rays are computed from them, so that both
/// are the same ray.
LocalRay random_local(test::Random& random, const Leaf& leaf) {
    const dvec3 half = leaf.box.extent() * 0.5 * leaf.frame.scale;
    LocalRay ray;
    ray.org = vec3(random.point(-1, 1) * half);
    dvec3 dir = random.point(-1, 1);
    dir /= std::abs(dir[major_axis(dir)]);
    ray.dir = vec3(dir);
    ray.t_end = 8;
    ray.skip = OVC_NO_TRIANGLE;
    return ray;
}

Ray to_world(const LocalRay& ray, const Leaf& leaf) {
    return {leaf.frame.origin + dvec3(ray.org) / leaf.frame.scale, 0,
            dvec3(ray.dir) / leaf.frame.scale, ray.t_end};
}

bool is_certain(const LocalAnswer& answer) {
    return answer.prim != OVC_FLAGGED && answer.rivals()[0] == OVC_NO_TRIANGLE;
}

TEST_F(KernelGl, WhatItCallsCertainIsTrue) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        if (soup.triangle_count() == 0)
            continue;
        SCOPED_TRACE(name);
        load(soup);
        const Leaf& leaf = leaf_of(level1);
        test::Random random(4);
        std::vector<LocalRay> rays;
        for (int i = 0; i < 2000; ++i)
            rays.push_back(random_local(random, leaf));
        const auto nearest = trace(rays, {});
        const auto any = trace(rays, {.any_hit = true});
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, leaf.triangles, to_world(rays[i], leaf));
            if (is_certain(nearest[i])) {
                const bool hit = nearest[i].prim != OVC_MISS;
                // Beyond its box a leaf promises nothing.
                const bool inside = !expected.is_hit() ||
                                    leaf.cell.contains(to_world(rays[i], leaf).at(expected.t));
                if (!inside)
                    continue;
                ASSERT_EQ(hit, expected.is_hit()) << "ray " << i;
                if (hit) {
                    ASSERT_EQ(leaf.triangles[nearest[i].prim], expected.id) << "ray " << i;
                }
            }
            if (is_certain(any[i])) {
                ASSERT_EQ(any[i].prim != OVC_MISS, expected.is_hit()) << "ray " << i;
            }
        }
    }
}

TEST_F(KernelGl, FlagsRaysAtSharedEdgesAndVertices) {
    const Soup soup = test::closed_grid(16);
    load(soup);
    const Leaf& leaf = leaf_of(level1);
    std::vector<LocalRay> rays;
    for (const TriangleId id : leaf.triangles) {
        const dvec3 corner = leaf.frame.to_local(soup.triangle(id)[0]);
        LocalRay ray{vec3(corner) - vec3(0, 0, 0.25f), 8, vec3(0, 0, 1), OVC_NO_TRIANGLE};
        rays.push_back(ray);
    }
    for (const LocalAnswer& answer : trace(rays, {}))
        EXPECT_EQ(answer.prim, OVC_FLAGGED);
}

TEST_F(KernelGl, NamesBothTrianglesAtASharedEdge) {
    const Soup soup = test::closed_grid(16);
    load(soup);
    const Leaf& leaf = leaf_of(level1);
    std::vector<LocalRay> rays;
    for (const TriangleId id : leaf.triangles) {
        const Triangle t = soup.triangle(id);
        const dvec3 middle = leaf.frame.to_local(0.5 * (t[0] + t[1]));
        rays.push_back({vec3(middle) - vec3(0, 0, 0.01f), 0.02f, vec3(0, 0, 1), OVC_NO_TRIANGLE});
    }
    const auto answers = trace(rays, {});
    for (size_t i = 0; i < rays.size(); ++i) {
        const auto rivals = answers[i].rivals();
        EXPECT_FALSE(is_certain(answers[i]));
        if (answers[i].prim != OVC_FLAGGED) {
            EXPECT_TRUE(rivals[0] == i || rivals[1] == i || answers[i].prim == i) << "ray " << i;
        }
    }
}

TEST_F(KernelGl, ANegativeEndIsNoRay) {
    load(test::closed_grid(8));
    std::vector<LocalRay> rays(3000, LocalRay{vec3(0, 0, -1), -1, vec3(0, 0, 1), OVC_NO_TRIANGLE});
    for (const LocalAnswer& answer : trace(rays, {}))
        EXPECT_EQ(answer.prim, OVC_MISS);
}

} // namespace
} // namespace ovc
