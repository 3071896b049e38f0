// SPDX-License-Identifier: Apache-2.0
// Tests what objects, looks and settings of a scene become. importers/pov/compare.py and
// tests/povray_test.cpp compare with POV-Ray itself.
#include "importers/pov/test_parse.h"
#include "importers/test_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace ovc {
namespace {

TEST(PovScene, ReadsLightsCameraAndSettings) {
    const Result<Scene> scene = parsed_scene(
        "camera { location <0, 0, -5> direction 2*z right -x*2 up y }\n"
        "light_source { <1, 2, 3> rgb <0.5, 1, 1> spotlight point_at <1, 0, 3> radius 10 falloff "
        "20 }\n"
        "global_settings { max_trace_level 9 ambient_light 2 }\nbackground { rgb <0, 0, 1> }\n"
        "sphere { 0, 1 pigment { rgbt <1, 0, 0, 0.5> } finish { ambient 0.1 diffuse 0.8 reflection "
        "0.3 } interior { ior 1.4 } no_shadow }");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->camera->eye, dvec3(0, 0, -5));
    EXPECT_EQ(scene->camera->window->right, dvec3(-2, 0, 0));
    EXPECT_EQ(scene->camera->window->direction, dvec3(0, 0, 2));
    ASSERT_EQ(scene->lights.size(), 1u);
    EXPECT_LT(glm::length(scene->lights[0].direction - dvec3(0, -1, 0)), 1e-12);
    EXPECT_NEAR(scene->lights[0].cone->falloff_cosine, std::cos(20 * 3.14159265358979 / 180), 1e-9);
    EXPECT_EQ(scene->max_depth, 8u); // the camera's ray is the first
    EXPECT_EQ(scene->background.zenith, vec3(0, 0, 1));
    ASSERT_EQ(scene->materials.size(), 1u);
    const Material& material = scene->materials[0];
    EXPECT_NEAR(material.finish->diffuse, 0.4, 1e-6) << "half of the light goes through";
    EXPECT_NEAR(material.finish->ambient.x, 0.1, 1e-6);
    EXPECT_EQ(material.finish->reflection, vec3(0.3f));
    EXPECT_NEAR(material.transmission, 0.5, 1e-6);
    EXPECT_EQ(material.ior, 1.4);
    EXPECT_EQ(scene->soup.chunks[0].mask(), kSeenByCamera | kSeenInReflections);
}

TEST(PovScene, InteriorsHaveMedia) {
    const std::string media =
        "#declare D = density { spherical };"
        "#declare F = media { emission 0.1 intervals 2 samples 20 density { D translate x } };"
        "#declare S = sphere { 0, 1 pigment { rgbt 1 } interior { media { F } "
        "media { scattering { 5, 0.2 eccentricity 0.4 extinction 0 } absorption <1, 2, 3> } } };"
        "light_source { 9, 1 media_interaction off media_attenuation on } ";
    const Result<Scene> scene =
        parsed_scene(media + "object { S scale 3 hollow } media { absorption 2 }");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->materials.at(0).media.size(), 2u);
    const Medium &glow = scene->materials[0].media[0], &fog = scene->materials[0].media[1];
    EXPECT_EQ(glow.samples, 11u) << "half as many, and one more";
    EXPECT_EQ(glow.intervals, 2u);
    EXPECT_EQ(fog.samples, 6u) << "povray's default";
    ASSERT_EQ(glow.densities.size(), 1u);
    EXPECT_LT(glm::length(glow.densities[0].at(dvec3(3, 0, 0))), 1e-12) << "it moves along";
    EXPECT_EQ(fog.phase, Medium::Phase::HenyeyGreenstein);
    EXPECT_EQ(fog.extinction, 0);
    EXPECT_EQ(fog.absorption, vec3(1, 2, 3));
    EXPECT_FALSE(scene->lights[0].lights_media);
    EXPECT_TRUE(scene->lights[0].fades_in_air);
    EXPECT_TRUE(scene->materials[0].hollow);
    EXPECT_EQ(scene->background.media.at(0).absorption, vec3(2));
    EXPECT_TRUE(parsed_scene(media + "object { S }")->materials.at(0).media.empty())
        << "not hollow";
    EXPECT_FALSE(parsed_scene(media + "object { S }")->materials.at(0).hollow);
    EXPECT_TRUE(scene->omissions.empty());
}

TEST(PovScene, DefaultsAreOfObjectsThatEndBehindThem) {
    const Result<Scene> scene = parsed_scene(
        "#default { pigment { rgb y } } sphere { 0, 1 } "
        "#declare Mesh = mesh { triangle { 0, x, y } } #declare Ball = sphere { 0, 1 } "
        "#declare Bright = sphere { 0, 1 finish { ambient 1 } } "
        "#default { pigment { rgb x } } object { Mesh } union { object { Ball } } "
        "object { Bright } union { sphere { 9, 1 } #default { pigment { rgb z } } }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 4u);
    EXPECT_EQ(scene->materials[0].color, vec3(0, 1, 0));
    EXPECT_EQ(scene->materials[1].color, vec3(1, 0, 0)) << "those that were declared before";
    EXPECT_EQ(scene->materials[2].color, vec3(0, 1, 0)) << "the rest of a texture, as it was read";
    EXPECT_EQ(scene->materials[3].color, vec3(0, 0, 1));
}

/// Returns the material of a box with this look, which povray 3.7.0.10 accepts as well.
Material material_of_box(const std::string& look) {
    const Result<Scene> scene = parsed_scene(
        "#declare P = pigment { rgb <1, 0.5, 0> }; #declare F = finish { ambient 0.3 };"
        "#declare N = normal { bumps 1 }; #declare T = texture { pigment { rgb z } finish { "
        "ambient 0.7 } }\nbox { -1, 1 " +
        look + " }");
    if (!scene || scene->meshes.size() != 1) {
        ADD_FAILURE() << look << ": " << (scene ? "no single mesh" : scene.error().message);
        return {};
    }
    return scene->materials[scene->meshes[0].material];
}

TEST(PovScene, TexturesTakePigmentsAndFinishesByName) {
    const vec3 orange(1, 0.5f, 0);
    EXPECT_EQ(material_of_box("texture { P }").color, orange);
    EXPECT_EQ(material_of_box("texture { P F }").finish->ambient, vec3(0.3f));
    EXPECT_EQ(material_of_box("texture { F P }").color, orange);
    EXPECT_EQ(material_of_box("texture { P N F }").finish->ambient, vec3(0.3f));
    EXPECT_EQ(material_of_box("texture { P finish { ambient 0.2 } }").finish->ambient, vec3(0.2f));
    const Material changed = material_of_box("texture { T P }");
    EXPECT_EQ(changed.color, orange);
    EXPECT_EQ(changed.finish->ambient, vec3(0.7f));
}

/// Words that stand elsewhere than usual, or that POV-Ray 3.8 added.
TEST(PovScene, WordsThatABlockHasAreTaken) {
    for (const char* scene :
         {"global_settings { charset utf8 assumed_gamma 1 }",
          "isosurface { function { y } contained_by { sphere { 0, 1 } } open max_gradient 4 }",
          "sphere { 0, 1 finish { specular 1 fresnel on } }",
          "sphere { 0, 1 pigment { pavement number_of_sides 3 number_of_tiles 1 pattern 1 } }"}) {
        const Result<Scene> read = parsed_scene(scene);
        EXPECT_TRUE(read) << scene << ": " << read.error().message;
    }
}

TEST(PovScene, LightMayComeFromBehind) {
    const auto finish = [](const std::string& object) {
        return *parsed_scene("#version 3.7; " + object)->materials.at(0).finish;
    };
    EXPECT_EQ(finish("box { 0, 1 finish { diffuse 0.6, 0.4 } }").diffuse_back, 0.4f);
    EXPECT_EQ(finish("union { box { 0, 1 } double_illuminate }").diffuse_back, 0.6f);
    EXPECT_EQ(finish("box { 0, 1 double_illuminate off }").diffuse_back, 0);
}

TEST(PovScene, TransmitsBelowZeroTurnColorsRound) {
    const Result<Scene> scene =
        parsed_scene("#version 3.7; box { 0, 1 pigment { rgb 0.5 transmit -1 } "
                     "finish { ambient 1 diffuse 0.5 } }");
    const Material& material = scene->materials.at(0);
    EXPECT_EQ(material.transmission * material.filter, vec3(-1));
    EXPECT_EQ(material.finish->diffuse, 1);
}

/// povray 3.7.0.10 draws `finish { ior 1.2 }` and `interior { ior 1.2 }` alike, with any version.
TEST(PovScene, OldFinishesRefract) {
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } finish { ior 1.5 refraction 1 }").ior, 1.5);
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } interior { ior 1.2 } finish { ior 1.5 }").ior,
              1.5);
    EXPECT_EQ(material_of_box("pigment { rgbf 1 } finish { refraction 0.5 }").transmission, 0.5f);
    EXPECT_EQ(material_of_box("texture { pigment { rgbf 1 } finish { ior 1.2 } } "
                              "texture { pigment { rgbf 1 } finish { ior 1.5 } }")
                  .ior,
              1.5)
        << "the uppermost layer's";
}

TEST(PovScene, FontsThatAreNotThereHaveAStandIn) {
    std::vector<std::string> messages;
    const auto scene =
        parse_pov("text { ttf \"no such font.ttf\" \"A\", 1, 0 }", "x.pov", gather(messages));
    if (!scene)
        GTEST_SKIP() << "no font is installed: " << scene.error().message;
    EXPECT_GT(triangles_of(scene).size(), 10u);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_TRUE(messages[0].starts_with("x.pov:1:8: found no font 'no such font.ttf'; "))
        << messages[0];
}

TEST(PovScene, VersionsMayComeFromOutside) {
    ImportOptions options;
    options.pov_version = 3.1;
    const std::string ball = "sphere { version*x, 0.1 }";
    EXPECT_NEAR(triangles_of(parse_pov(ball, "x.pov", options))[0][0].x, 3.1, 0.11);
    EXPECT_EQ(parsed_scene(ball)->gamma, kSrgbGamma);
    options.pov_version = 3.7;
    EXPECT_EQ(parse_pov(ball, "x.pov", options)->gamma, 1) << "colors are light from 3.7 on";
    EXPECT_EQ(parse_pov("#version 3.5;" + ball, "x.pov", options)->gamma, kSrgbGamma);
}

TEST(PovScene, ThingsInheritTheLookOfTheirGroup) {
    const Result<Scene> scene = parsed_scene(
        "union { sphere { 0, 1 } sphere { x, 1 pigment { rgb y } } pigment { rgb x } }");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->materials.size(), 2u);
    EXPECT_EQ(scene->materials[0].color, vec3(1, 0, 0));
    EXPECT_EQ(scene->materials[1].color, vec3(0, 1, 0));
}

} // namespace
} // namespace ovc
