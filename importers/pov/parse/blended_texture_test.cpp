// SPDX-License-Identifier: Apache-2.0
#include "core/texture/pattern.h"
#include "importers/pov/test_parse.h"
#include "importers/scene_file/sound_textures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

static Scene blended_scene(const std::string& text) {
    Result<Scene> scene = parsed_scene("#version 3.7;\n" + text);
    if (!scene) {
        ADD_FAILURE() << text << ": " << scene.error().message;
        return {};
    }
    EXPECT_TRUE(scene->omissions.empty()) << text;
    return std::move(*scene);
}

/// Returns the share of the second texture of the first mesh's mix.
static double second_share(const Scene& scene, TexturePoint at) {
    const Material& material = scene.materials.at(scene.meshes.at(0).material);
    if (!material.mix) {
        ADD_FAILURE() << "no mix";
        return -1;
    }
    const Texture& mix = scene.textures.at(material.mix->texture);
    EXPECT_EQ(mix.stops.size(), 2u);
    return evaluate(scene.textures, mix.pattern, mix.on_uv ? moved_to_uv(at) : material.mix->at(at))
        .value;
}

TEST(PovBlend, ABlobHasTheTexturesOfItsPartsByTheirStrengths) {
    const Scene scene =
        blended_scene("blob { threshold 0.3 sphere { -0.5*x, 1, 1 pigment { rgb x } } "
                      "cylinder { -2*y, 2*y, 2, 2 scale 0.5 translate 0.5*x pigment { rgb y } } "
                      "sphere { 5*x, 1, -9 pigment { rgb x } } translate 3*z }");
    EXPECT_NEAR(second_share(scene, dvec3(0, 0, 3)), 2 / 3.0, 1e-9);
    EXPECT_NEAR(second_share(scene, dvec3(0.5, 0.5, 3)), 1, 1e-9) << "beyond the sphere";
    const double ball = 0.5625, rod = 2 * 0.15 * 0.15;
    EXPECT_NEAR(second_share(scene, dvec3(-0.3, 0, 3 - std::sqrt(0.21))), rod / (ball + rod), 1e-9);
    EXPECT_FALSE(blended_scene("blob { threshold 0.3 sphere { 0, 1, 1 pigment { rgb x } } "
                               "sphere { 0, 2, 1 pigment { rgb x } } }")
                     .materials.at(0)
                     .mix)
        << "all have the same";
    EXPECT_EQ(
        blended_scene("blob { threshold 0.3 sphere { 0, 1, 1 } sphere { 0, 2, 1 pigment { rgb x "
                      "} } pigment { rgb z } translate x }")
            .materials.at(0)
            .color,
        vec3(0, 0, 1));
}

TEST(PovBlend, ABlobMayHaveHundredsOfTextures) {
    const Scene scene = blended_scene(
        "#declare I = 0; blob { threshold 0.3 #while (I < 400) sphere { 3*<mod(I, 20), int(I/20), "
        "0>, 1, 1 pigment { rgb I/400 } } #declare I = I + 1; #end }");
    EXPECT_NEAR(second_share(scene, dvec3(57, 27, 0)), 0, 1e-12);
    EXPECT_NEAR(second_share(scene, dvec3(0, 30, 0)), 1, 1e-12);
    EXPECT_TRUE(scene.omissions.empty());
    EXPECT_TRUE(has_sound_textures(scene));
}

TEST(PovBlend, ATriangleHasTheTexturesOfItsCorners) {
    const Scene scene = blended_scene(
        "mesh2 { vertex_vectors { 3, 0, x, y } texture_list { 2, texture { pigment { rgb x } } "
        "texture { pigment { rgb y } } } face_indices { 1, <0, 1, 2>, 0, 1, 1 } translate 9*x }");
    TexturePoint at(dvec3(0));
    at.has_uv = true;
    at.uv = {0.25, 0.5};
    EXPECT_NEAR(second_share(scene, at), 0.75, 1e-6);
    EXPECT_EQ(scene.meshes.at(0).uv, (std::vector<vec2>{vec2(0), vec2(1, 0), vec2(0, 1)}));
    EXPECT_EQ(blended_scene("#declare T = texture { pigment { rgb x } } #declare U = texture { T } "
                            "mesh { triangle { 0, x, y texture_list { T U T } } }")
                  .meshes.at(0)
                  .uv.size(),
              3u);
    const Result<Scene> two = parsed_scene("#declare T = texture { pigment { rgb x } } "
                                           "mesh { triangle { 0, x, y texture_list { T T } } }");
    ASSERT_FALSE(two);
    EXPECT_NE(two.error().message.find("found 2 textures of a triangle's corners, expected 3"),
              std::string::npos);
}

TEST(PovBlend, MapsOfTexturesLieOnTextureCoordinates) {
    const Scene scene = blended_scene(
        "sphere { 0, 1 texture { uv_mapping gradient x texture_map { [0 pigment { rgb x "
        "}] [1 pigment { rgb y }] } } translate 7*y }");
    EXPECT_NEAR(second_share(scene, dvec3(0, 7, -1)), 0.75, 1e-6);
    EXPECT_NEAR(second_share(scene, dvec3(-1, 7, 0)), 0.5, 1e-6);
}

} // namespace ovc
