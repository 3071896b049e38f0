// SPDX-License-Identifier: Apache-2.0
// Shading: positions, normals and the light that arrives, on single triangles.
#include "host/shade.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ovc {

/// One triangle in the plane y = 0 around the origin, seen from above or below.
static Scene floor_scene(std::vector<vec3> normals = {}, dvec3 origin = dvec3(0)) {
    Scene scene;
    scene.materials = {{"", vec3(0.5f), 0.25f}};
    scene.add_mesh("floor", 0, Chunk::owning(origin, {{-1, 0, 1}, {1, 0, 1}, {0, 0, -2}}),
                   std::move(normals));
    return scene;
}

static const Hit kHit{1, 0.3, 0.3, {0, 0}};
static const Ray kFromAbove{{0, 1, 0}, 0, {0, -1, 0}};
static const Ray kFromBelow{{0, -1, 0}, 0, {0, 1, 0}};

TEST(SurfacePoint, NormalsFaceTheRayOnBothSides) {
    const Scene scene = floor_scene();
    EXPECT_EQ(surface_point(scene, kFromAbove, kHit).normal, vec3(0, 1, 0));
    EXPECT_EQ(surface_point(scene, kFromBelow, kHit).normal, vec3(0, -1, 0));
}

TEST(SurfacePoint, InterpolatesNormalsAndIgnoresThoseThatCancel) {
    const vec3 tilted = glm::normalize(vec3(1, 1, 0));
    EXPECT_LT(
        glm::length(surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kHit).normal -
                    tilted),
        1e-6f);
    const vec3 nothing(0);
    EXPECT_EQ(surface_point(floor_scene({nothing, nothing, nothing}), kFromAbove, kHit).normal,
              vec3(0, 1, 0));
}

TEST(SurfacePoint, LiesJustOnTheRaysSideOfTheTriangle) {
    for (const dvec3 origin : {dvec3(0), dvec3(0, 1e6, 0)}) {
        const Scene scene = floor_scene({}, origin);
        const double above = surface_point(scene, kFromAbove, kHit).position.y - origin.y;
        const double below = surface_point(scene, kFromBelow, kHit).position.y - origin.y;
        EXPECT_GT(above, 0);
        EXPECT_LT(above, 1e-7);
        EXPECT_LT(below, 0);
        EXPECT_GT(below, -1e-7);
    }
}

TEST(SurfacePoint, HasANormalHoweverSmallTheTriangle) {
    Scene scene;
    scene.add_mesh("speck", 0,
                   Chunk::owning(dvec3(0), {{0, 0, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0}}));
    EXPECT_EQ(surface_point(scene, {{0, 0, 1}, 0, {0, 0, -1}}, kHit).normal, vec3(0, 0, 1));
}

TEST(DirectLight, FollowsTheCosineAndStopsBehindTheSurface) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kHit);
    const PointLight overhead{{s.position.x, 5, s.position.z}, vec3(std::numbers::pi_v<float>)};
    EXPECT_NEAR(direct_light(overhead, s).x, 0.5, 1e-6);
    const PointLight slanting{s.position + dvec3(1, 1, 0), vec3(std::numbers::pi_v<float>)};
    EXPECT_NEAR(direct_light(slanting, s).x, 0.5 * std::sqrt(0.5), 1e-6);
    EXPECT_EQ(direct_light({{0, -5, 0}, vec3(1)}, s), vec3(0));
}

TEST(DirectLight, DoesNotShineThroughTheTriangleOntoATiltedNormal) {
    const vec3 tilted = glm::normalize(vec3(1, 0.1f, 0));
    const SurfacePoint s = surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kHit);
    EXPECT_EQ(direct_light({s.position + dvec3(5, -0.2, 0), vec3(1)}, s), vec3(0));
}

TEST(ShadowRay, EndsAtTheLight) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kHit);
    const PointLight light{{3, 4, 5}, vec3(1)};
    const Ray ray = shadow_ray(light, s);
    EXPECT_EQ(ray.t_max, 1);
    EXPECT_LT(glm::length(ray.at(1) - light.position), 1e-12);
}

TEST(MirrorRay, LeavesAtTheAngleItCame) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kHit);
    EXPECT_EQ(mirror_ray({{-1, 1, 0}, 0, {1, -1, 0}}, s).dir, dvec3(1, 1, 0));
}

TEST(MirrorRay, NeverGoesBelowThePlane) {
    const vec3 tilted = glm::normalize(vec3(1, 0.2f, 0));
    const SurfacePoint s = surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kHit);
    EXPECT_GT(mirror_ray({{1, 0.3, 0}, 0, {-1, -0.3, 0}}, s).dir.y, 0);
}

TEST(BackgroundColor, RunsFromHorizonToZenithAndStaysBelow) {
    const Background b{vec3(1, 0, 0), vec3(0, 0, 1)};
    const vec3 up(0, 1, 0);
    EXPECT_EQ(background_color(b, up, {1, 0, 0}), b.horizon);
    EXPECT_EQ(background_color(b, up, {0, 7, 0}), b.zenith);
    EXPECT_EQ(background_color(b, up, {0, -7, 0}), b.horizon);
}

TEST(AmbientLight, IsStrongerFromAbove) {
    const Scene scene = floor_scene();
    const vec3 up(0, 1, 0);
    EXPECT_GT(ambient_light({}, up, surface_point(scene, kFromAbove, kHit)).x,
              ambient_light({}, up, surface_point(scene, kFromBelow, kHit)).x);
}

} // namespace ovc
