// SPDX-License-Identifier: Apache-2.0
// Tests the summary of a scene.
#include "host/scene/scene_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

TEST(SceneSummary, CountsWhatCannotBeHitAndLeavesItOutOfTheBounds) {
    Scene scene;
    scene.add_mesh("good", 0, Chunk::owning({10, 0, 0}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 2}}));
    scene.add_mesh(
        "bad", 0,
        Chunk::owning(dvec3(0),
                      {{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}, {99, 0, 0}, {99, 1, 0}, {99, 2, 0}}));
    const SceneSummary s = summarize(scene);
    EXPECT_EQ(s.triangles, 3u);
    EXPECT_EQ(s.meshes, 2u);
    EXPECT_EQ(s.dropped.not_finite, 1u);
    EXPECT_EQ(s.dropped.degenerate, 1u);
    EXPECT_EQ(s.bounds.lo, dvec3(10, 0, 0));
    EXPECT_EQ(s.bounds.hi, dvec3(11, 1, 2));
    EXPECT_EQ(hittable_bounds(scene.soup).hi, s.bounds.hi);
}

TEST(SceneSummary, CountsInstancesAsTheirTriangles) {
    Scene scene;
    scene.add_mesh(
        "one", 0,
        Chunk::owning(dvec3(0),
                      {{0, 0, 0}, {1, 0, 0}, {0, 1, 2}, {0, 0, 0}, {1, 1, 1}, {2, 2, 2}}));
    scene.add_mesh("two", 0, Chunk::owning(dvec3(5), {{0, 0, 0}, {1, 0, 0}, {0, 1, 2}}));
    const auto place = [&](uint32_t mesh, const Transform& transform) {
        Chunk chunk = scene.soup.chunks[mesh].instance();
        chunk.place(transform);
        scene.add_mesh("instance", 0, std::move(chunk));
    };
    const Transform turned{{{{0, -1, 0, 3}, {1, 0, 0, 0}, {0, 0, 1, 0}}}};
    const Transform flat{{{{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}}};
    const Transform far{{{{1, 0, 0, -40}, {0, 1, 0, 0}, {0, 0, 3, 0}}}};
    for (const uint32_t mesh : {0u, 1u})
        for (const Transform& transform : {turned, turned, flat, far, turned})
            place(mesh, transform);
    const SceneSummary s = summarize(scene);
    Dropped dropped;
    Box bounds;
    hittable_triangles(scene.soup, &dropped, &bounds);
    EXPECT_EQ(s.dropped.degenerate, dropped.degenerate);
    EXPECT_EQ(s.dropped.degenerate, 8u); // a line in each of six, and two that are flat
    for (const Box& box : {s.bounds, hittable_bounds(scene.soup)}) {
        EXPECT_EQ(box.lo, bounds.lo);
        EXPECT_EQ(box.hi, bounds.hi);
    }
}

TEST(SceneSummary, KnowsWhatIsNeeded) {
    Scene scene;
    scene.materials = {{"dull"}, {"mirror", vec3(1), 0.5f}};
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.add_mesh("plain", 0, Chunk::owning(dvec3(0), corners));
    EXPECT_FALSE(summarize(scene).needs.vertex_normals);
    EXPECT_FALSE(summarize(scene).needs.reflection); // the mirror is not used
    scene.add_mesh("smooth", 1, Chunk::owning(dvec3(0), corners),
                   std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_TRUE(summarize(scene).needs.vertex_normals);
    EXPECT_TRUE(summarize(scene).needs.reflection);
    EXPECT_FALSE(summarize(scene).needs.refraction);
}

TEST(SceneSummary, GlassNeedsReflectionTooAsItMayReflectTotally) {
    Scene scene;
    scene.materials = {{"glass", vec3(1), 0, 0.5f}};
    EXPECT_FALSE(summarize(scene).needs.refraction);
    scene.add_mesh("pane", 0, Chunk::owning(dvec3(0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_TRUE(summarize(scene).needs.refraction);
    EXPECT_TRUE(summarize(scene).needs.reflection);
    for (const LeftOut& item : summarize(scene).left_out)
        EXPECT_EQ(item.what.find("rays"), std::string::npos) << item.what;
}

TEST(SceneSummary, NamesAndCountsWhatIsNotDrawnAsMeant) {
    EXPECT_EQ(omissions_text({}), "");
    EXPECT_EQ(omissions_text({{"fog is left out", 1}, {"an area light is a point", 3}}),
              "not drawn as its author meant: fog is left out (1); an area light is a point (3)");
}

TEST(SceneSummary, ListsAllThatIsLeftOutAndNothingThatIsNeeded) {
    Scene scene;
    scene.materials = {{"dull"}, {"glass", vec3(1), 0, 0.5f}};
    const std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.add_mesh("flat", 0, Chunk::owning(dvec3(0), corners));
    const auto text = [&](const Query& query) {
        return left_out_text(left_out_of(scene, needs_of(scene, query)));
    };
    EXPECT_EQ(text({}), "reflection rays, refraction rays");
    EXPECT_EQ(text({false, false, 1}),
              "reflection rays, refraction rays, shadow rays, queues of rays, proofs of answers");
    scene.meshes[0].normals_left_out = 2;
    scene.meshes[0].texture_coordinates_left_out = 3;
    EXPECT_EQ(text({}), "vertex normals (24 bytes), texture coordinates (24 bytes), reflection "
                        "rays, refraction rays");
    // The others need their normals; glass needs both rays.
    scene.add_mesh("smooth", 1, Chunk::owning(dvec3(0), corners),
                   std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_EQ(text({}), "vertex normals (24 bytes), texture coordinates (24 bytes)");
    const Needs needs = needs_of(scene);
    EXPECT_TRUE(needs.vertex_normals && needs.reflection && needs.refraction && needs.shadows &&
                needs.several_leaves && needs.certified);
    EXPECT_FALSE(needs.texture_coordinates);
}

TEST(SceneSummary, OfNothingHasNoBounds) {
    EXPECT_TRUE(summarize(Scene{}).bounds.empty());
}

} // namespace ovc
