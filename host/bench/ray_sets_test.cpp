// SPDX-License-Identifier: Apache-2.0
// Tests that the bench's rays are the same on every run and lie where geometry says.
#include "host/bench/ray_sets.h"
#include "host/camera/camera.h"
#include "host/scene/scene_summary.h"
#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace ovc {
namespace {

constexpr uint32_t kSetWidth = 100, kSetHeight = 60;

Scene lit(const char* name) {
    Result<Scene> made = make_test_scene(name);
    EXPECT_TRUE(bool(made));
    Scene scene = std::move(*made);
    scene.lights = {{{3, 50, 20}, vec3(1)}};
    return scene;
}

std::vector<RaySet> sets_of(const Scene& scene, uint32_t width = kSetWidth,
                            uint32_t height = kSetHeight) {
    const Camera camera = framing_camera(hittable_bounds(scene.soup), width, height);
    Result<std::vector<RaySet>> sets =
        make_ray_sets(scene, camera, width, height, *make_cpu_backend(scene.soup));
    EXPECT_TRUE(bool(sets));
    return std::move(*sets);
}

TEST(RaySets, HaveShadowsWhereTheSceneHasNoLight) {
    Scene scene = lit("box");
    scene.lights.clear();
    const auto sets = make_ray_sets(scene, framing_camera(hittable_bounds(scene.soup), 16, 16), 16,
                                    16, *make_cpu_backend(scene.soup));
    ASSERT_TRUE(sets);
    EXPECT_FALSE((*sets)[1].rays.empty());
}

TEST(RaySets, AreTheSameOnEveryRun) {
    const Scene scene = lit("sphere-3");
    const std::vector<RaySet> a = sets_of(scene), b = sets_of(scene);
    ASSERT_EQ(a.size(), 3u);
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].name, b[i].name);
        ASSERT_EQ(a[i].rays.size(), b[i].rays.size());
        ASSERT_FALSE(a[i].rays.empty());
        EXPECT_EQ(std::memcmp(a[i].rays.data(), b[i].rays.data(), a[i].rays.size() * sizeof(Ray)),
                  0);
    }
}

TEST(RaySets, HaveOneRayAPixelAndOneAHit) {
    const Scene scene = lit("sphere-3");
    const std::vector<RaySet> sets = sets_of(scene);
    EXPECT_EQ(sets[0].rays.size(), kSetWidth * kSetHeight);
    std::vector<Hit> hits(sets[0].rays.size());
    ASSERT_TRUE(make_cpu_backend(scene.soup)->intersect(sets[0].rays, {}, hits));
    const auto seen = size_t(
        std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.is_hit(); }));
    EXPECT_LT(seen, hits.size());
    EXPECT_EQ(sets[1].rays.size(), seen);
    EXPECT_EQ(sets[2].rays.size(), seen);
}

TEST(RaySets, ShadowRaysEndAtTheLight) {
    const Scene scene = lit("sphere-3");
    const RaySet shadow = std::move(sets_of(scene)[1]);
    EXPECT_EQ(shadow.query, RayQuery::Occlusion);
    for (const Ray& ray : shadow.rays) {
        EXPECT_EQ(ray.t_max, 1);
        EXPECT_LT(glm::length(ray.at(1) - scene.lights[0].position), 1e-12);
    }
}

/// A ray that leaves a convex body outwards never meets it again, not even where it begins.
TEST(RaySets, BouncesLeaveAConvexBody) {
    const Scene scene = lit("sphere-4");
    const RaySet diffuse = std::move(sets_of(scene)[2]);
    std::vector<Hit> hits(diffuse.rays.size());
    ASSERT_TRUE(make_cpu_backend(scene.soup)->intersect(diffuse.rays, {}, hits));
    for (size_t i = 0; i < hits.size(); ++i)
        EXPECT_FALSE(hits[i].is_hit()) << "ray " << i;
}

/// Returns the distance at which a ray passes a point.
double distance(const Ray& ray, dvec3 point) {
    return glm::length(glm::cross(glm::normalize(ray.dir), point - ray.org));
}

/// Rays hit the edges of a convex body that they aim at, except a few on its silhouette.
TEST(RaySets, RaysAtEdgesHitWhatTheyAimAt) {
    const Scene scene = lit("sphere-3");
    const Camera camera = framing_camera(hittable_bounds(scene.soup), kSetWidth, kSetHeight);
    const auto reference = make_cpu_backend(scene.soup);
    const Result<RaySet> edges = make_edge_set(scene, camera, kSetWidth, kSetHeight, *reference);
    ASSERT_TRUE(bool(edges));
    EXPECT_EQ(edges->name, "edges");
    EXPECT_EQ(edges->rays.size(), sets_of(scene)[1].rays.size());
    std::vector<Hit> hits(edges->rays.size());
    ASSERT_TRUE(reference->intersect(edges->rays, {}, hits));
    size_t at_corners = 0, missed = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].is_hit()) {
            ++missed;
            continue;
        }
        EXPECT_LT(std::min({hits[i].u, hits[i].v, 1 - hits[i].u - hits[i].v}), 1e-9) << "ray " << i;
        const Triangle triangle = scene.soup.triangle(hits[i].id);
        at_corners += std::ranges::any_of(std::array{0, 1, 2}, [&](int c) {
            return distance(edges->rays[i], triangle[c]) < 1e-9;
        });
    }
    EXPECT_LT(missed, hits.size() / 20);
    EXPECT_GT(at_corners, hits.size() / 3);
    EXPECT_LT(at_corners, hits.size() * 2 / 3);
}

/// The cosine of directions that are distributed as the cosine has the mean 2/3 and the standard
/// deviation 0.236.
TEST(RaySets, BouncesAreDistributedAsTheCosine) {
    Scene scene;
    scene.add_mesh(
        "floor", 0,
        Chunk::owning({0, 0, 0},
                      {{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}));
    scene.materials.emplace_back();
    scene.lights = {{{0, 5, 0}, vec3(1)}};
    Camera camera;
    camera.eye = {0, 3, 1};
    camera.target = {0, 0, 0};
    const Result<std::vector<RaySet>> sets =
        make_ray_sets(scene, camera, 200, 200, *make_cpu_backend(scene.soup));
    ASSERT_TRUE(bool(sets));
    const std::vector<Ray>& rays = (*sets)[2].rays;
    ASSERT_EQ(rays.size(), 40000u);
    double sum = 0;
    for (const Ray& ray : rays) {
        EXPECT_GT(ray.dir.y, 0);
        EXPECT_NEAR(glm::length(ray.dir), 1, 1e-12);
        sum += ray.dir.y;
    }
    EXPECT_NEAR(sum / double(rays.size()), 2.0 / 3.0, 5 * 0.236 / 200);
}

} // namespace
} // namespace ovc
