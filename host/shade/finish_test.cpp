// SPDX-License-Identifier: Apache-2.0
// POV-Ray's finish, term by term, on one triangle; tests/povray_test.cpp has POV-Ray judge them.
#include "host/shade/finish.h"

#include "core/texture/pattern.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace ovc {

static constexpr Hit kHit{1, 0.3, 0.3, {0, 0}};
static const vec3 kColor{0.5f, 0.25f, 1};

/// A triangle in the plane y = 0 with this finish, seen along (1, -1, 0).
struct SeenTriangle {
    Scene scene;
    SurfacePoint point;

    explicit SeenTriangle(const Finish& finish, double ior = 1, float transmission = 0) {
        Material material;
        material.color = kColor;
        material.ior = ior;
        material.transmission = transmission;
        material.finish = finish;
        scene.materials = {material};
        scene.add_mesh("", 0, Chunk::owning(dvec3(0), {{-1, 0, 1}, {1, 0, 1}, {0, 0, -2}}));
        point = surface_point(scene, {{-1, 1, 0}, 0, {1, -1, 0}}, kHit);
    }
};

static const dvec3 kMirrored = dvec3(1, 1, 0) * std::sqrt(0.5);

static void expect_near(const vec3& found, const vec3& expected) {
    EXPECT_LT(max_component(glm::abs(found - expected)), 1e-6f)
        << found.x << " " << found.y << " " << found.z;
}

TEST(Finish, DiffuseFollowsTheCosineToThePowerOfBrilliance) {
    Finish finish;
    finish.diffuse = 0.6f;
    finish.brilliance = 3;
    const dvec3 slanting(std::sqrt(0.75), 0.5, 0);
    expect_near(finish_light(SeenTriangle(finish).point, slanting, vec3(2), true),
                2 * 0.6f / 8 * kColor);
}

TEST(Finish, AmbientIsTheFinishesOwn) {
    Finish finish;
    finish.ambient = {0.1f, 0.2f, 0.3f};
    const Background sky;
    expect_near(ambient_light(sky, {0, 1, 0}, SeenTriangle(finish).point), finish.ambient * kColor);
}

TEST(Finish, HighlightsPeakAtTheMirrorsAngle) {
    Finish finish;
    finish.diffuse = 0;
    finish.phong = 0.75f;
    finish.specular = 0.5f;
    const SurfacePoint& point = SeenTriangle(finish).point;
    expect_near(finish_light(point, kMirrored, vec3(1), true), vec3(1.25f));
    EXPECT_LT(finish_light(point, {0, 1, 0}, vec3(1), true).x, 0.2f);
    expect_near(finish_light(point, kMirrored, vec3(1), /* highlights= */ false), vec3(0));
}

/// povray 3.7.0.10 draws a white plane with these lamps and films so, relative to one without.
TEST(Finish, FilmsHaveTheColorsThatPovrayDraws) {
    Finish finish;
    finish.irid = 0.2f;
    finish.irid_thickness = 0.1f;
    const auto factor = [](const Finish& film, const dvec3& at, const dvec3& view,
                           const dvec3& towards) {
        SeenTriangle seen(film);
        seen.point.position = at;
        seen.point.view = view;
        const vec3 with = finish_light(seen.point, towards, vec3(1), true);
        return (with / finish_light(SeenTriangle({}).point, towards, vec3(1), true) - 1.0f) /
               film.irid;
    };
    const dvec3 up(0, 1, 0);
    const vec3 along = factor(finish, dvec3(0), -up, up);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(along[i], vec3(-0.2225f, -0.7486f, -0.8661f)[i], 1e-3);
    finish.irid_thickness = 0.5f;
    EXPECT_NEAR(factor(finish, dvec3(0), -up, {std::sqrt(1 - 0.7035 * 0.7035), 0.7035, 0}).x, 0.207,
                2e-3);
    finish.irid_thickness = 0.02f;
    finish.irid_turbulence = 1;
    // The film there is 1.7356 times as thick.
    EXPECT_NEAR(factor(finish, {-0.875, 0.875, 0}, -up, up).x,
                std::cos(2 * std::numbers::pi * 2 * 0.02 * 1.7356 / 0.7), 1e-3);
}

TEST(Finish, AverageTexturesAreMixedByTheirWeights) {
    SeenTriangle seen({});
    Scene& scene = seen.scene;
    scene.materials[0].finish = Finish{};
    scene.materials.push_back({"other", vec3(1, 0, 0.5f)});
    scene.materials[1].finish = Finish{};
    scene.materials.push_back({"mixed"});
    Texture mix;
    mix.pattern.kind = Pattern::Kind::Average;
    mix.stops = {{3, {}, 0}, {1, {}, 1}};
    scene.textures = {mix};
    scene.materials[2].finish = Finish{};
    scene.materials[2].mix = PlacedTexture{0};
    scene.meshes[0].material = 2;
    const SurfacePoint point = surface_point(scene, {{-1, 1, 0}, 0, {1, -1, 0}}, kHit);
    ASSERT_EQ(point.coats.size(), 2u);
    expect_near(point.color, 0.75f * kColor + 0.25f * vec3(1, 0, 0.5f));
}

TEST(Finish, MetalColorsItsHighlight) {
    Finish finish;
    finish.diffuse = 0;
    finish.specular = 1;
    finish.metallic = 1;
    const vec3 light = finish_light(SeenTriangle(finish).point, kMirrored, vec3(1), true);
    EXPECT_NEAR(light.x, 0.5, 0.05);
    EXPECT_NEAR(light.y, 0.25, 0.05);
    EXPECT_NEAR(light.z, 1, 1e-6);
}

TEST(Finish, ReflectionRunsFromHeadOnToGrazing) {
    Finish finish;
    finish.reflection = vec3(0.2f);
    finish.grazing_reflection = vec3(1, 1, 0.2f);
    finish.reflection_falloff = 2;
    const float grazing = std::pow(1 - std::sqrt(0.5f), 2.0f);
    expect_near(branches(SeenTriangle(finish).point, false).mirror,
                {0.2f + 0.8f * grazing, 0.2f + 0.8f * grazing, 0.2f});
}

TEST(Finish, FresnelReflectsMoreTheFlatterTheRay) {
    Finish finish;
    finish.grazing_reflection = vec3(1);
    finish.fresnel = true;
    // Fresnel's equations at 45 degrees, from 1 to 1.5: the mean of 0.0920 and 0.00847.
    EXPECT_NEAR(branches(SeenTriangle(finish, 1.5).point, false).mirror.x, 0.0502, 1e-4);
}

TEST(Finish, PartsAreAddedUnlessEnergyIsConserved) {
    Finish finish;
    finish.reflection = finish.grazing_reflection = vec3(0.4f);
    const Branches sum = branches(SeenTriangle(finish, 1.5, 0.5f).point, false);
    expect_near(sum.mirror, vec3(0.4f));
    expect_near(sum.through, vec3(0.5f));
    EXPECT_EQ(sum.taken_by_mirror + sum.taken_by_through, 0);
    finish.conserve_energy = true;
    expect_near(branches(SeenTriangle(finish, 1.5, 0.5f).point, false).through, vec3(0.3f));
}

/// As povray 3.7.0.10: a coat over a mirror filters the paint below it, not what it mirrors.
TEST(Finish, CoatsDoNotDimTheMirrorBelow) {
    SeenTriangle seen({}, 1, 0.5f);
    Scene& scene = seen.scene;
    Material mirror{"mirror"};
    mirror.finish = Finish{};
    mirror.finish->reflection = mirror.finish->grazing_reflection = vec3(0.4f);
    scene.materials.push_back(mirror);
    scene.materials[0].under = 1;
    const SurfacePoint point = surface_point(scene, {{-1, 1, 0}, 0, {1, -1, 0}}, kHit);
    ASSERT_EQ(point.coats.size(), 2u);
    EXPECT_LT(max_component(point.coats[1].weight), 0.6f);
    expect_near(branches(point, false).mirror, vec3(0.4f));
}

TEST(Finish, TotalReflectionLosesNoLight) {
    // As povray 3.7.0.10: through two faces that let 0.9 through, and a third that reflects
    // totally, comes 0.81 of the sky; it is the same for reflection 0.3, with and without
    // conserve_energy.
    for (const bool conserve : {false, true}) {
        Finish finish;
        finish.reflection = finish.grazing_reflection = vec3(0.3f);
        finish.conserve_energy = conserve;
        const Branches total = branches(SeenTriangle(finish, 1.5, 0.9f).point, true);
        EXPECT_EQ(total.mirror, vec3(1));
        EXPECT_EQ(total.through, vec3(0));
    }
}

/// As povray 3.7.0.10 draws `slope` and `aoi` together with a normal.
TEST(Finish, SlopesAreThoseOfTiltedNormals) {
    Scene scene = SeenTriangle({}).scene;
    const std::array<dvec4, 3> unmoved{dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};
    scene.textures = {{{.kind = Pattern::Kind::AngleOfIncidence}, {{0, {vec3(0)}}, {1, {vec3(1)}}}},
                      {{.kind = Pattern::Kind::Bozo}, {{}}}};
    scene.materials[0].texture = PlacedTexture{0, unmoved};
    const auto seen = [&] { return surface_point(scene, {{-1, 1, 0}, 0, {1, -1, 0}}, kHit); };
    const float flat = seen().color.x;
    scene.materials[0].bump = Bump{.kind = Bump::Kind::Noise, .amount = 2, .pattern = {1, unmoved}};
    const SurfacePoint tilted = seen();
    const TexturePoint there{tilted.position, tilted.normal, tilted.view};
    EXPECT_NEAR(tilted.color.x, color_at(scene.textures, 0, there).rgb.x, 1e-5);
    EXPECT_GT(std::abs(tilted.color.x - flat), 0.01f);
}

TEST(Checker, TakesTurnsCubeByCube) {
    Scene scene = SeenTriangle({}).scene;
    scene.textures = {{{.kind = Pattern::Kind::Checker}, {{0, {kColor}}, {1, {vec3(0)}}}}};
    scene.materials[0].texture =
        PlacedTexture{0, {dvec4(2, 0, 0, 0), dvec4(0, 2, 0, 0), dvec4(0, 0, 2, 0)}};
    const auto color = [&](double u, double v) {
        return surface_point(scene, {{-1, 1, 0}, 0, {1, -1, 0}}, {1, u, v, {0, 0}}).color;
    };
    EXPECT_EQ(color(0.6, 0.1), vec3(0)); // in cubes: 0.6, 1.4; one is odd
    EXPECT_EQ(color(0.4, 0.1), kColor);  // -0.2, 1.8; both are
}

} // namespace ovc
