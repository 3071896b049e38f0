// SPDX-License-Identifier: Apache-2.0
// Tests the lights of a scene.
#include "importers/pov/test_parse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace ovc {
namespace {

/// As povray 3.7.0.10 draws them: the lights of the innermost group count, and the global_lights of
/// the outermost.
TEST(PovLights, ShineInTheirGroup) {
    const Result<Scene> scene = parsed_scene(
        "light_source { <0, 9, 0> rgb 1 } sphere { 0, 1 pigment { rgb 1 } } "
        "light_group { light_source { <9, 9, 0> rgb 1 } sphere { 1, 1 pigment { rgb x } } "
        "light_group { light_source { <0, 9, 9> rgb 1 } box { 3, 4 pigment { rgb y } } "
        "global_lights off } global_lights on }");
    ASSERT_TRUE(scene) << scene.error().message;
    const std::vector<std::vector<bool>> lit = {
        {true, false, false}, {true, true, false}, {true, false, true}};
    ASSERT_EQ(scene->meshes.size(), lit.size());
    for (size_t m = 0; m < lit.size(); ++m)
        for (size_t l = 0; l < scene->lights.size(); ++l)
            EXPECT_EQ(scene->meshes[m].lit_by.includes(scene->lights[l].group), lit[m][l])
                << scene->meshes[m].name << " " << l;
}

/// As measured of povray 3.7.0.10.
TEST(PovLights, AreOfTheKindNamedLast) {
    const auto light = [](const std::string& words) {
        const Result<Scene> scene = parsed_scene("light_source { 1, 1 " + words + " }");
        return scene && scene->lights.size() == 1 ? scene->lights[0] : Light{};
    };
    EXPECT_TRUE(light("spotlight shadowless").shadowless);
    EXPECT_FALSE(light("spotlight shadowless").cone);
    EXPECT_FALSE(light("shadowless").lights_media);
    EXPECT_FALSE(light("shadowless spotlight").shadowless);
    EXPECT_TRUE(light("shadowless spotlight").lights_media);
    EXPECT_TRUE(light("shadowless spotlight").cone);
    EXPECT_TRUE(light("spotlight cylinder").beam);
    EXPECT_FALSE(light("spotlight cylinder").cone);
    EXPECT_TRUE(light("cylinder shadowless").parallel);
    const Light narrow = light("spotlight radius 20 falloff 10");
    ASSERT_TRUE(narrow.cone);
    EXPECT_EQ(narrow.cone->falloff_cosine, narrow.cone->radius_cosine);
    const Light even = light("cylinder radius 0 falloff 2");
    ASSERT_TRUE(even.beam);
    EXPECT_EQ(even.beam->radius, 2);
}

TEST(PovScene, LightsAreProjectedThroughObjects) {
    const Result<Scene> scene =
        parsed_scene("#declare S = sphere { y, 1 pigment { rgb 1 } } light_source "
                     "{ 5*y, 1 projected_through { S } translate x }");
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->meshes.empty()) << "it is not seen";
    const std::optional<Region>& projector = scene->lights.at(0).projector;
    ASSERT_TRUE(projector);
    EXPECT_NEAR(projector->first_crossing({1, -3, 0}, {0, 1, 0}, 0), 3, 1e-9);
    EXPECT_TRUE(std::isinf(projector->first_crossing({-0.5, -3, 0}, {0, 1, 0}, 0)));
    EXPECT_TRUE(scene->omissions.empty());
    EXPECT_FALSE(parsed_scene("light_source { y, 1 projected_through { 3 } }"));
}

TEST(PovScene, AreaLightsAreGrids) {
    const Result<Scene> scene =
        parsed_scene("sphere { 0, 1 } light_source { y, rgb 6 area_light 4*x, 2*z, "
                     "3, 2 adaptive 1 translate 5*y }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->lights.size(), 6u);
    for (const Light& light : scene->lights)
        EXPECT_EQ(light.position, dvec3(0, 6, 0)) << "all of them shine from the middle";
    EXPECT_EQ(scene->lights[0].shadow_offset, dvec3(-2, 0, -1));
    EXPECT_EQ(scene->lights[5].shadow_offset, dvec3(2, 0, 1));
    EXPECT_FLOAT_EQ(scene->lights[0].color.x, std::numbers::pi_v<float>);
    EXPECT_TRUE(scene->omissions.empty());
    const std::string spot = "light_source { 5*y, 1 spotlight point_at 0 area_light 10*x, z, 2, 1 ";
    EXPECT_EQ(parsed_scene(spot + "translate x }")->lights.at(0).direction, dvec3(0, -1, 0));
    const Result<Scene> spots = parsed_scene(spot + "area_illumination on translate x }");
    EXPECT_EQ(spots->lights.at(0).position, dvec3(-4, 5, 0));
    EXPECT_LT(glm::length(spots->lights.at(0).direction - glm::normalize(dvec3(5, -5, 0))), 1e-12);
    const Result<Scene> round =
        parsed_scene("light_source { 0, 1 area_light 2*x, 2*y, 3, 3 circular }");
    EXPECT_NEAR(glm::length(round->lights.at(0).shadow_offset), 1, 1e-12) << "a corner";
    EXPECT_EQ(round->lights.at(1).shadow_offset, dvec3(-1, 0, 0));
    const Result<Scene> facing =
        parsed_scene("light_source { 0, 1 area_light 2*x, y, 2, 2 orient translate z }");
    EXPECT_TRUE(facing->lights.at(0).faces_places);
    EXPECT_NEAR(glm::length(facing->lights.at(0).shadow_offset), 1, 1e-12) << "as wide as long";
    EXPECT_EQ(facing->lights.at(0).area_points, 4u);
}

/// Many lights are drawn by fewer, which lie as far from the middle as those do on average.
TEST(PovScene, LargeAreaLightsAreDrawnByFewer) {
    const auto moment = [](const std::string& words) {
        const Result<Scene> scene =
            parsed_scene("light_source { y, 1 area_light 10*x, z, " + words + "}");
        double sum = 0;
        for (const Light& light : scene->lights)
            sum += light.shadow_offset.x * light.shadow_offset.x / double(scene->lights.size());
        return std::pair(scene->lights.size(), sum);
    };
    const double of_17 = 100.0 / 12 * 18 / 16, cell = 100.0 / 12 / (16 * 16);
    EXPECT_EQ(moment("17, 1").first, 17u);
    EXPECT_EQ(moment("17, 17").first, 144u);
    EXPECT_EQ(moment("1000, 4").first, 144u);
    EXPECT_NEAR(moment("17, 1").second, of_17, 1e-9);
    EXPECT_NEAR(moment("17, 17").second, of_17, 1e-9);
    EXPECT_NEAR(moment("17, 17 jitter").second, of_17 + cell, 1e-9);
}

TEST(PovScene, GetsNoLightThatItDoesNotHave) {
    const Result<Scene> scene = parsed_scene("sphere { 0, 1 finish { ambient 0.2 } }");
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->lights.empty());
    EXPECT_FALSE(scene->may_add_light);
}

} // namespace
} // namespace ovc
