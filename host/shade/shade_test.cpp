// SPDX-License-Identifier: Apache-2.0
// Tests of shading: positions, normals and the light that arrives, on single triangles.
#include "host/shade/shade.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ovc {

/// Returns one triangle in the plane y = 0 around the origin, to be seen from above or below.
static Scene floor_scene(std::vector<vec3> normals = {}, dvec3 origin = dvec3(0)) {
    Scene scene;
    scene.materials = {{"", vec3(0.5f), 0.25f}};
    scene.add_mesh("floor", 0, Chunk::owning(origin, {{-1, 0, 1}, {1, 0, 1}, {0, 0, -2}}),
                   std::move(normals));
    return scene;
}

static const Hit kShadedHit{1, 0.3, 0.3, {0, 0}};
static const Ray kFromAbove{{0, 1, 0}, 0, {0, -1, 0}};
static const Ray kFromBelow{{0, -1, 0}, 0, {0, 1, 0}};

TEST(SurfacePoint, NormalsFaceTheRayOnBothSides) {
    const Scene scene = floor_scene();
    EXPECT_EQ(surface_point(scene, kFromAbove, kShadedHit).normal, dvec3(0, 1, 0));
    EXPECT_EQ(surface_point(scene, kFromBelow, kShadedHit).normal, dvec3(0, -1, 0));
}

TEST(SurfacePoint, InterpolatesNormalsAndIgnoresThoseThatCancel) {
    const vec3 tilted = glm::normalize(vec3(1, 1, 0));
    EXPECT_LT(
        glm::length(
            surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kShadedHit).normal -
            dvec3(tilted)),
        1e-6);
    const vec3 nothing(0);
    EXPECT_EQ(
        surface_point(floor_scene({nothing, nothing, nothing}), kFromAbove, kShadedHit).normal,
        dvec3(0, 1, 0));
}

TEST(SurfacePoint, LiesJustOnTheRaysSideOfTheTriangle) {
    for (const dvec3 origin : {dvec3(0), dvec3(0, 1e6, 0)}) {
        const Scene scene = floor_scene({}, origin);
        const double above = surface_point(scene, kFromAbove, kShadedHit).position.y - origin.y;
        const double below = surface_point(scene, kFromBelow, kShadedHit).position.y - origin.y;
        EXPECT_EQ(surface_point(scene, kFromAbove, kShadedHit).beyond.y - origin.y, below);
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
    EXPECT_EQ(surface_point(scene, {{0, 0, 1}, 0, {0, 0, -1}}, kShadedHit).normal, dvec3(0, 0, 1));
}

TEST(SurfacePoint, KeepsClearOfTheEdgesOfItsTriangle) {
    for (const dvec3 origin : {dvec3(0), dvec3(0, 1e6, 0)}) {
        const Scene scene = floor_scene({}, origin);
        const Triangle t = scene.soup.triangle(kShadedHit.id);
        const SurfacePoint at_corner = surface_point(scene, kFromAbove, {1, 0, 0, {0, 0}});
        const double away = glm::length(at_corner.position - t[0]);
        const double above = at_corner.position.y - origin.y;
        EXPECT_GT(away, 32 * above) << "a neighbour at a sharp angle to this one would be crossed";
        EXPECT_LT(away, 0x1p-30 * max_component(glm::abs(t[1]))) << "float cannot tell";
        // A hit away from the edges is not moved.
        EXPECT_NEAR(surface_point(scene, kFromAbove, kShadedHit).position.x, -1 + 0.3 * 2 + 0.3,
                    1e-15);
    }
}

TEST(SurfacePoint, KnowsWhetherTheRayEnters) {
    EXPECT_TRUE(surface_point(floor_scene(), kFromAbove, kShadedHit).entering);
    EXPECT_FALSE(surface_point(floor_scene(), kFromBelow, kShadedHit).entering);
}

TEST(SurfacePoint, TheNormalOfASliverIsThatOfExactArithmetic) {
    // One unit in the last place keeps its corners from being on one line.
    const float step = 0x1p-23f;
    Scene scene;
    scene.add_mesh("sliver", 0,
                   Chunk::owning(dvec3(0), {{0, 0, 0}, {1, 1, 1}, {3, 3 + 2 * step, 3}}));
    const dvec3 exact = glm::normalize(dvec3(-1, 0, 1));
    const Ray ray{{0, 0, 5}, 0, {0.1, 0, -1}};
    EXPECT_LT(glm::length(surface_point(scene, ray, kShadedHit).normal - exact), 1e-15);
}

TEST(DirectLight, FollowsTheCosineAndStopsBehindTheSurface) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    const Light overhead{{s.position.x, 5, s.position.z}, vec3(std::numbers::pi_v<float>)};
    EXPECT_NEAR(direct_light(overhead, s).x, 0.5, 1e-6);
    const Light slanting{s.position + dvec3(1, 1, 0), vec3(std::numbers::pi_v<float>)};
    EXPECT_NEAR(direct_light(slanting, s).x, 0.5 * std::sqrt(0.5), 1e-6);
    EXPECT_EQ(direct_light({{0, -5, 0}, vec3(1)}, s), vec3(0));
}

TEST(DirectLight, FromBehindCountsWhereTheFinishSaysSo) {
    Scene scene;
    Material material;
    material.color = vec3(0.5f);
    material.finish = Finish{.diffuse_back = 0.4f, .brilliance = 2};
    scene.materials = {material};
    scene.add_mesh("", 0, Chunk::owning(dvec3(0), {{-1, 0, 1}, {1, 0, 1}, {0, 0, -2}}));
    const SurfacePoint point =
        surface_point(scene, {{0, 1, 0}, 0, {0, -1, 0}}, Hit{1, 0.3, 0.3, {0, 0}});
    Light below;
    below.position = point.position + dvec3(std::sqrt(3), -1, 0); // a cosine of 1/2
    const vec3 light = direct_light(below, point);
    EXPECT_NEAR(light.x, below.color.x * std::numbers::inv_pi_v<float> * 0.5f * 0.4f / 4, 1e-6f);
    scene.materials[0].finish->diffuse_back = 0;
    EXPECT_EQ(direct_light(below, point), vec3(0));
}

TEST(DirectLight, DoesNotShineThroughTheTriangleOntoATiltedNormal) {
    const vec3 tilted = glm::normalize(vec3(1, 0.1f, 0));
    const SurfacePoint s =
        surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kShadedHit);
    EXPECT_EQ(direct_light({s.position + dvec3(5, -0.2, 0), vec3(1)}, s), vec3(0));
}

TEST(DirectLight, OfASpotlightStaysInItsCone) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    Light light{s.position + dvec3(0, 4, 0), vec3(std::numbers::pi_v<float>)};
    light.cone = SpotCone{std::cos(0.2), std::cos(0.4), 2};
    const auto at_angle = [&](double angle) {
        light.direction = {std::sin(angle), -std::cos(angle), 0};
        return direct_light(light, s).x;
    };
    EXPECT_NEAR(at_angle(0), 0.5, 1e-6);
    EXPECT_NEAR(at_angle(0.15), 0.5 * std::pow(std::cos(0.15), 2), 1e-6);
    EXPECT_GT(at_angle(0.3), 0.05);
    EXPECT_LT(at_angle(0.3), 0.4);
    EXPECT_EQ(at_angle(0.41), 0);
    EXPECT_EQ(at_angle(std::numbers::pi), 0) << "the cone does not open backwards";
}

TEST(DirectLight, FadesWithDistanceToHalfOfWhatItWouldBeTwiceAsNear) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    Light light{s.position + dvec3(0, 3, 0), vec3(std::numbers::pi_v<float>)};
    light.fade_distance = 3;
    light.fade_power = 2;
    EXPECT_NEAR(direct_light(light, s).x, 0.5, 1e-6) << "as it is at fade_distance";
    light.position.y = s.position.y + 6;
    EXPECT_NEAR(direct_light(light, s).x, 0.5 * 2 / 5, 1e-6);
    // The square law, as core/scene.h tells an importer to write it: color 12 at distance 6.
    light.fade_distance = 1e-6;
    light.color *= 12 / (2 * 1e-12f);
    EXPECT_NEAR(direct_light(light, s).x, 0.5 * 12 / 36, 1e-5);
}

TEST(DirectLight, ParallelLightComesFromOneSideEverywhere) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    Light light{dvec3(100, 2, 0), vec3(std::numbers::pi_v<float>)};
    light.parallel = true;
    light.direction = glm::normalize(dvec3(0, -1, 1));
    EXPECT_NEAR(direct_light(light, s).x, 0.5 * std::sqrt(0.5), 1e-6);
    const Ray ray = shadow_ray(light, s.position);
    EXPECT_LT(glm::length(glm::normalize(ray.dir) + light.direction), 1e-12);
    EXPECT_NEAR(glm::dot(ray.at(1) - light.position, light.direction), 0, 1e-12);
}

/// As povray 3.7 draws a plane that a cylinder of light with radius 2 and falloff 5 meets head on.
TEST(DirectLight, BeamsAreFullNearTheirAxis) {
    Light light{dvec3(0, 10, 0), vec3(1)};
    light.parallel = true;
    light.direction = {0, -1, 0};
    light.beam = LightBeam{2, 5, 0};
    const auto off_axis = [&](double x) { return double(light_at(light, {x, 0, 0}).color.x); };
    for (const auto& [x, share] : {std::pair(1.9, 1.0), {2.5, 0.9259}, {4.5, 0.0741}, {5.1, 0.0}})
        EXPECT_NEAR(off_axis(x), share, 1e-4) << x;
    light.beam->tightness = 1;
    for (const auto& [x, share] : {std::pair(0.0, 1.0), {1.0, 0.8}, {2.5, 0.463}, {4.0, 0.0519}})
        EXPECT_NEAR(off_axis(x), share, 1e-4) << x;
}

TEST(DirectLight, KeepsToItsGroup) {
    Scene scene = floor_scene();
    scene.meshes[0].lit_by = {.group = 1, .group_alone = true};
    const SurfacePoint s = surface_point(scene, kFromAbove, kShadedHit);
    Light light{{3, 4, 5}, vec3(1)};
    EXPECT_EQ(direct_light(light, s), vec3(0));
    light.group = 1;
    EXPECT_GT(direct_light(light, s).x, 0);
}

TEST(ShadowRay, EndsBeforeWhatTheLightLiesOn) {
    Light light{{0, 10, 0}, vec3(1)};
    light.clearance = 1e-3;
    EXPECT_NEAR(shadow_ray(light, dvec3(0)).t_max, 1 - 1e-4, 1e-12);
    EXPECT_EQ(shadow_ray(light, {0, 10, 0}).t_max, 0);
}

TEST(ShadowRay, EndsWhereTheLightIsProjectedThrough) {
    Light light{{0, 10, 0}, vec3(1)};
    PlacedRound ball{{.base = {0, 5, 0}, .radius = 1}, {}};
    ball.to_shape = {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};
    light.projector = Region{.rounds = {ball}};
    EXPECT_NEAR(shadow_ray(light, dvec3(0)).t_max, 0.4, 1e-12);
    EXPECT_NEAR(shadow_ray(light, {0, 5, 0}).t_max, 0.2, 1e-12) << "from inside";
    EXPECT_EQ(light_at(light, dvec3(0)).color, vec3(1));
    EXPECT_EQ(light_at(light, {4, 0, 0}).color, vec3(0)) << "beside it";
    EXPECT_EQ(light_at(light, {0, 7, 0}).color, vec3(0)) << "above it";
    light.shadow_offset = {6, 0, 0};
    EXPECT_EQ(light_at(light, dvec3(0)).color, vec3(0)) << "of this point of the area";
}

TEST(ShadowRay, ToADistantLightHasNoEnd) {
    Light light{.parallel = true, .distant = true};
    light.direction = {0, -1, 0};
    for (const double height : {-3.0, 0.0, 3.0}) { // its position is no plane that light comes from
        const Ray ray = shadow_ray(light, {5, height, 2});
        EXPECT_EQ(ray.dir, dvec3(0, 1, 0)) << height;
        EXPECT_TRUE(std::isinf(ray.t_max)) << height;
        EXPECT_EQ(light_at(light, {5, height, 2}).towards, dvec3(0, 1, 0)) << height;
    }
}

TEST(ShadowRay, EndsAtTheLight) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    const Light light{{3, 4, 5}, vec3(1)};
    const Ray ray = shadow_ray(light, s.position);
    EXPECT_EQ(ray.t_max, 1);
    EXPECT_LT(glm::length(ray.at(1) - light.position), 1e-12);
}

TEST(MirrorRay, LeavesAtTheAngleItCame) {
    const SurfacePoint s = surface_point(floor_scene(), kFromAbove, kShadedHit);
    EXPECT_EQ(mirror_ray({{-1, 1, 0}, 0, {1, -1, 0}}, s).dir, dvec3(1, 1, 0));
}

TEST(MirrorRay, NeverGoesBelowThePlane) {
    const vec3 tilted = glm::normalize(vec3(1, 0.2f, 0));
    const SurfacePoint s =
        surface_point(floor_scene({tilted, tilted, tilted}), kFromAbove, kShadedHit);
    EXPECT_GT(mirror_ray({{1, 0.3, 0}, 0, {-1, -0.3, 0}}, s).dir.y, 0);
}

/// The floor is of glass, with its index of refraction below the plane, seen from above and below.
static Scene glass_scene(double ior, std::vector<vec3> normals = {}) {
    Scene scene = floor_scene(std::move(normals));
    scene.materials = {{"glass", vec3(0), 0, 1, vec3(1), ior}};
    return scene;
}

TEST(RefractedRay, BendsTowardsTheNormalGoingInAndAwayGoingOut) {
    const Scene scene = glass_scene(1.5);
    const Ray in{{-1, 1, 0}, 0, {1, -1, 0}};
    const auto inside = refracted_ray(in, surface_point(scene, in, kShadedHit));
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->dir.x / glm::length(inside->dir), std::sqrt(0.5) / 1.5, 1e-15);
    EXPECT_LT(inside->org.y, 0);
    const Ray out{{0, -1, 0}, 0, {0.5, 1, 0}};
    const auto outside = refracted_ray(out, surface_point(scene, out, kShadedHit));
    ASSERT_TRUE(outside);
    EXPECT_NEAR(outside->dir.x / glm::length(outside->dir), 1.5 * std::sqrt(0.2), 1e-15);
    EXPECT_GT(outside->org.y, 0);
}

TEST(RefractedRay, BeyondTheCriticalAngleThereIsNone) {
    const Scene scene = glass_scene(1.5);
    const Ray flat{{-1, -1, 0}, 0, {1, 1, 0}}; // 45 degrees, the critical angle is 41.8
    EXPECT_FALSE(refracted_ray(flat, surface_point(scene, flat, kShadedHit)));
}

TEST(RefractedRay, StaysOnItsSideOfThePlaneWhateverTheVertexNormals) {
    for (double tilt = -3; tilt <= 3; tilt += 0.01) {
        const vec3 tilted(float(std::sin(tilt)), float(std::cos(tilt)), 0);
        const Scene scene = glass_scene(1.5, {tilted, tilted, tilted});
        for (const double slope : {-20.0, -1.0, 0.0, 3.0, 1e6}) {
            const Ray down{{0, 1, 0}, 0, {slope, -1, 0}}, up{{0, -1, 0}, 0, {slope, 1, 0}};
            for (const Ray& ray : {down, up}) {
                const SurfacePoint s = surface_point(scene, ray, kShadedHit);
                EXPECT_GT(mirror_ray(ray, s).dir.y * -ray.dir.y, 0) << tilt << " " << slope;
                const auto beyond = refracted_ray(ray, s);
                EXPECT_TRUE(!beyond || beyond->dir.y * ray.dir.y > 0) << tilt << " " << slope;
            }
        }
    }
}

TEST(BackgroundColor, RunsFromHorizonToZenithAndStaysBelow) {
    const Background b{vec3(1, 0, 0), vec3(0, 0, 1)};
    Scene scene;
    scene.background = b;
    const vec3 up(0, 1, 0);
    EXPECT_EQ(background_color(scene, up, {1, 0, 0}), b.horizon);
    EXPECT_EQ(background_color(scene, up, {0, 7, 0}), b.zenith);
    EXPECT_EQ(background_color(scene, up, {0, -7, 0}), b.horizon);
}

TEST(BackgroundColor, IsSeenThroughItsLayers) {
    Scene scene;
    scene.background = {vec3(0.2f, 0.4f, 0.6f), vec3(0.2f, 0.4f, 0.6f), {PlacedTexture{0}}};
    scene.textures = {{{.kind = Pattern::Kind::Gradient, .parameters = {0, 1, 0}},
                       {{0.4, {vec3(1)}}, {0.6, {vec3(0.5f, 0.6f, 0.7f), 0.4f}}}}};
    scene.background.layers[0].to_texture = {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0),
                                             dvec4(0, 0, 1, 0)};
    EXPECT_EQ(background_color(scene, vec3(0, 1, 0), {5, 0, 0}), vec3(1));
    // povray 3.7.0.10 prints these numbers for sky_sphere { pigment { rgb <0.2, 0.4, 0.6> }
    // pigment { rgbf <0.5, 0.6, 0.7, 0.4> } }.
    const vec3 seen = background_color(scene, vec3(0, 1, 0), {3, 4, 0});
    EXPECT_NEAR(seen.x, 0.34, 1e-6);
    EXPECT_NEAR(seen.y, 0.456, 1e-6);
    EXPECT_NEAR(seen.z, 0.588, 1e-6);
}

TEST(AmbientLight, IsStrongerFromAbove) {
    const Scene scene = floor_scene();
    const vec3 up(0, 1, 0);
    EXPECT_GT(ambient_light({}, up, surface_point(scene, kFromAbove, kShadedHit)).x,
              ambient_light({}, up, surface_point(scene, kFromBelow, kShadedHit)).x);
}

} // namespace ovc
