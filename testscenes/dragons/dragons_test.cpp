// SPDX-License-Identifier: Apache-2.0
// The dragon scenes: the generated creature, and a model in its place.
#include "testscenes/catalog.h"
#include "testscenes/closed_test.h"
#include "testscenes/dragons/creature.h"
#include "testscenes/sphere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace ovc {
namespace {

using dragons::make_creature;

Soup soup_of(Corners corners, dvec3 origin = dvec3(0)) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(origin, std::move(corners)));
    return soup;
}

Box bounds_of(const Chunk& chunk) {
    Box bounds;
    for (const vec3& corner : chunk.corners())
        bounds.add(chunk.origin() + dvec3(corner));
    return bounds;
}

TEST(Creature, HasTheTrianglesAskedForAndIsClosedWhereTheyAreEven) {
    for (const uint64_t triangles : {20'000u, 20'002u, 31'337u, 123'456u}) {
        const Surface creature = make_creature(triangles, triangles % 2 == 1);
        EXPECT_EQ(creature.corners.size(), 3 * triangles);
        EXPECT_EQ(creature.normals.size(), triangles % 2 == 1 ? 3 * triangles : 0);
        if (triangles % 2 == 0) {
            EXPECT_EQ(open_edges(creature.corners), 0u) << triangles;
            EXPECT_GT(enclosed_volume(creature.corners), 0.1) << triangles;
        }
    }
}

TEST(Creature, StandsOnTheGround) {
    const Surface creature = make_creature(50'000, false);
    Box bounds;
    for (const vec3& corner : creature.corners)
        bounds.add(dvec3(corner));
    EXPECT_NEAR(bounds.lo.y, 0, 0.03);
    EXPECT_NEAR(bounds.hi.y, 1.7, 0.2);
    EXPECT_NEAR(bounds.extent().x, 2.6, 0.4);
}

TEST(DragonScenes, ShowAModelScaledToFit) {
    Corners ball = make_sphere(2);
    for (vec3& corner : ball)
        corner = vec3(4000, 1000, 20) * corner;
    const Soup model = soup_of(std::move(ball), dvec3(1e6, -3e5, 7));
    const Result<Scene> scene = make_test_scene("dragons-9", &model);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->soup.triangle_count(), 204'800u + 9 * 320);
    for (size_t m = 1; m < scene->soup.chunks.size(); ++m) {
        const Box bounds = bounds_of(scene->soup.chunks[m]);
        EXPECT_NEAR(bounds.lo.y, 0, 1e-6) << m;
        EXPECT_NEAR(bounds.extent().x, 2.6, 1e-5) << m;
        EXPECT_NEAR(bounds.extent().y, 0.65, 0.01) << m;
        for (size_t other = 1; other < m; ++other) { // none stands in another
            const Box b = bounds_of(scene->soup.chunks[other]);
            EXPECT_TRUE(bounds.lo.x > b.hi.x || bounds.hi.x < b.lo.x || bounds.lo.z > b.hi.z ||
                        bounds.hi.z < b.lo.z)
                << m << " " << other;
        }
    }
}

TEST(DragonScenes, CopiesOutliveAMoveOfTheScene) {
    const Soup model = soup_of(make_sphere(1));
    Result<Scene> made = make_test_scene("dragons-3", &model);
    ASSERT_TRUE(made);
    const Triangle before = made->soup.triangle({3, 17});
    const Scene moved = std::move(*made);
    made = Error{"gone"};
    EXPECT_EQ(moved.soup.triangle({3, 17}), before);
    EXPECT_EQ(moved.soup.chunks[2].owned_bytes(), 0u) << "one model in memory, whatever the count";
}

TEST(DragonScenes, SayWhenAModelWillNotDo) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Soup empty, point = soup_of(Corners(3, vec3(1))), none = soup_of(Corners(3, vec3(nan)));
    for (const Soup* model : {&empty, &point, &none})
        EXPECT_EQ(make_test_scene("dragons-2", model).error().message,
                  "the model has no triangle that a ray can hit");
    const Soup model = soup_of(make_sphere(0));
    EXPECT_EQ(make_test_scene("knot", &model).error().message,
              "the test scene knot shows no model of yours; dragons-N and dragonball do");
}

TEST(Dragonball, HasNormalsEverywhereAndGlass) {
    Corners corners = make_sphere(1);
    corners.insert(corners.end(), 3, vec3(std::numeric_limits<float>::infinity()));
    const Soup model = soup_of(std::move(corners));
    const Result<Scene> scene = make_test_scene("dragonball", &model);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->soup.triangle_count(), 145'772u + 81);
    int closed_glass = 0;
    for (size_t m = 0; m < scene->meshes.size(); ++m) {
        const Chunk& chunk = scene->soup.chunks[m];
        ASSERT_EQ(scene->meshes[m].normals.size(), chunk.corners().size());
        for (const vec3& normal : scene->meshes[m].normals)
            ASSERT_NEAR(glm::length(normal), 1, 1e-5) << scene->meshes[m].name;
        if (scene->materials[scene->meshes[m].material].transmission > 0) {
            EXPECT_EQ(open_edges(chunk.corners()), 0u) << scene->meshes[m].name;
            EXPECT_GT(enclosed_volume(chunk.corners()), 0.05) << "glass looks outwards";
            ++closed_glass;
        }
    }
    EXPECT_EQ(closed_glass, 2);
}

TEST(Dragonball, HasTheTrianglesOfTheThesis) {
    const Result<Scene> scene = make_test_scene("dragonball");
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->soup.triangle_count(), 7'364'817u);
    Dropped dropped;
    hittable_triangles(scene->soup, &dropped, nullptr);
    EXPECT_EQ(dropped.total(), 0u);
}

} // namespace
} // namespace ovc
