// SPDX-License-Identifier: Apache-2.0
// The transparent places of image_maps become cutouts, which lie where POV-Ray's picture lies.
#include "core/texture/pattern.h"
#include "importers/readers.h"
#include "importers/test_files.h"

namespace ovc::pov {
namespace {

/// A white texel that is opaque beside a black one that is a hole, in RGBA and by a table.
std::string opaque_and_hole() {
    return png_of(2, 1, {255, 255, 255, 255, 0, 0, 0, 0});
}
std::string table() {
    return png_of(3, 1, {0, 1, 2}, {std::string("\xff\0\0\0\xff\0\xff\xff\xff", 9)});
}

struct Read {
    Scene scene;
    std::vector<std::string> warnings;
};

/// Reads the text, in which PNG, TABLE and OPAQUE stand for the names of pictures.
Read read(std::string text) {
    const TestFolder folder;
    for (const auto& [word, bytes] : {std::pair<std::string, std::string>("PNG", opaque_and_hole()),
                                      {"TABLE", table()},
                                      {"OPAQUE", png_of(1, 1, {9, 9, 9, 255})}})
        for (size_t at; (at = text.find(word)) != text.npos;)
            text.replace(at, word.size(),
                         '"' + folder.write(word.substr(0, 2), bytes).string() + '"');
    Read read;
    Result<Scene> scene = parse_pov("#version 3.7; global_settings { assumed_gamma 1 } " + text,
                                    "x.pov", gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    return read;
}

/// Returns the texture coordinates that a mesh's triangles have at a place, which lies in one.
std::optional<dvec2> uv_at(const Scene& scene, uint32_t mesh, const dvec3& at) {
    const Chunk& chunk = scene.soup.chunks[mesh];
    for (uint32_t prim = 0; prim < chunk.size(); ++prim) {
        const Triangle t = chunk.triangle(prim);
        const dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
        const auto share = [&](int i) {
            return glm::dot(normal,
                            glm::cross(t[(i + 2) % 3] - t[(i + 1) % 3], at - t[(i + 1) % 3])) /
                   glm::dot(normal, normal);
        };
        const dvec3 shares(share(0), share(1), share(2));
        if (std::abs(glm::dot(normal, at - t[0])) > 1e-9)
            continue;
        if (shares.x < -1e-9 || shares.y < -1e-9 || shares.z < -1e-9)
            continue;
        const std::array<vec2, 3> uv = scene.uv_of(scene.meshes[mesh]).of(prim);
        return shares.x * dvec2(uv[0]) + shares.y * dvec2(uv[1]) + shares.z * dvec2(uv[2]);
    }
    return std::nullopt;
}

void expect_at(const Scene& scene, const dvec3& at, const dvec2& expected) {
    const std::optional<dvec2> uv = uv_at(scene, 0, at);
    ASSERT_TRUE(uv);
    EXPECT_NEAR(uv->x, expected.x, 1e-5);
    EXPECT_NEAR(uv->y, expected.y, 1e-5);
}

TEST(PovHoles, ComeFromOpacity) {
    const Read found = read("box { 0, 1 pigment { image_map { png PNG } } }");
    ASSERT_EQ(found.scene.cutouts.size(), 1u);
    EXPECT_EQ(found.scene.cutouts[0], (Cutout{.width = 2, .height = 1, .opacity = {255, 0}}));
    ASSERT_EQ(found.scene.meshes.size(), 1u);
    EXPECT_EQ(found.scene.meshes[0].cutout, 0u);
    // The color is that of what is there, which lets nothing through.
    EXPECT_EQ(found.scene.materials[0].color, vec3(1));
    EXPECT_EQ(found.scene.materials[0].transmission, 0);
}

TEST(PovHoles, ComeFromColorsOfATable) {
    const auto opacity = [](const std::string& words) {
        const Read found = read("box { 0, 1 pigment { image_map { png TABLE " + words + " } } }");
        return found.scene.cutouts.empty() ? std::vector<uint8_t>()
                                           : found.scene.cutouts[0].opacity;
    };
    using Opacity = std::vector<uint8_t>;
    EXPECT_EQ(opacity(""), Opacity());
    EXPECT_EQ(opacity("transmit 1, 1"), (Opacity{255, 0, 255}));
    EXPECT_EQ(opacity("transmit 1, 1 transmit 0, 0.6"), (Opacity{102, 0, 255}));
    EXPECT_EQ(opacity("filter 2, 1"), (Opacity{255, 255, 0})) << "white, as clear as can be";
    EXPECT_EQ(opacity("filter 0, 1"), (Opacity{170, 255, 255})) << "red lets a third through";
    EXPECT_EQ(opacity("transmit 1, 1 transmit all 0.2"), (Opacity{255, 0, 255}));
    EXPECT_EQ(opacity("transmit all 1"), Opacity()) << "the same everywhere";
    EXPECT_EQ(opacity("filter all 0.5"), Opacity());
    EXPECT_EQ(opacity("once"), (Opacity{255, 255, 255})) << "a hole around it";
}

TEST(PovHoles, KeepWhatAllOfThePictureLetsThrough) {
    for (const char* words : {"", "once", "transmit 1, 1"}) {
        const Read found = read("box { 0, 1 pigment { image_map { png TABLE transmit all 0.25 " +
                                std::string(words) + " } } }");
        const Material& material = found.scene.materials[0];
        const vec3 through =
            material.texture
                ? color_at(found.scene.textures, material.texture->texture, dvec3(0)).through()
                : material.filter;
        EXPECT_NEAR(material.transmission * through.x, 0.25, 1e-6);
        EXPECT_EQ(found.scene.meshes[0].uv.empty(), *words == '\0');
    }
}

TEST(PovHoles, TakeTheWordsOfTheMap) {
    const Scene scene =
        read("box { 0, 1 pigment { image_map { png PNG once interpolate 2 } } }").scene;
    EXPECT_EQ(scene.cutouts.at(0).beyond, Cutout::Beyond::Hole);
    EXPECT_TRUE(scene.cutouts[0].smooth);
    const Read round = read("sphere { 0, 1 pigment { image_map { png PNG map_type 1 } } }");
    EXPECT_TRUE(round.scene.cutouts.empty());
    ASSERT_TRUE(round.scene.materials[0].texture);
    const ImageTexture& image =
        round.scene.textures[round.scene.materials[0].texture->texture].image.value();
    EXPECT_TRUE(image.is_transparent) << "holes are only cut on x and y";
    EXPECT_NEAR(image.otherwise.transmit, 0.5, 1e-6) << "the average";
    EXPECT_TRUE(round.warnings.empty());
}

TEST(PovHoles, LieOnXAndY) {
    const std::string polygon =
        "polygon { 5, <0, 0>, <4, 0>, <4, 4>, <0, 4>, <0, 0> pigment { image_map { png PNG } ";
    expect_at(read(polygon + "} }").scene, {1, 3, 0}, {1, 3});
    expect_at(read(polygon + "scale 4 translate x } }").scene, {1, 3, 0}, {0, 0.75});
    const Scene moved = read(polygon + "scale 4 } rotate 90 * x translate <5, 6, 7> }").scene;
    expect_at(moved, {6, 6, 10}, {0.25, 0.75});
    expect_at(read("plane { z, 2 pigment { image_map { png PNG } scale 2 } }").scene, {3, -1, 2},
              {1.5, -0.5});
    const Scene solid =
        read(
            "difference { box { 0, <4, 4, 1> } box { <1, 1, -1>, <2, 2, 2> } pigment { image_map { "
            "png PNG } scale 2 } translate 3 * x }")
            .scene;
    expect_at(solid, {6, 3, 0}, {1.5, 1.5});
    EXPECT_FALSE(uv_at(solid, 0, {4.5, 1.5, 0}));
}

TEST(PovHoles, LieOnTheTextureCoordinatesOfMeshes) {
    const std::string mesh = "mesh { triangle { <0, 0, 0>, <1, 0, 0>, <0, 1, 0> uv_vectors <0.5, "
                             "0>, <1, 0>, <0.5, 0.25> } ";
    const std::string mesh2 =
        "mesh2 { vertex_vectors { 3, <0, 0, 0>, <1, 0, 0>, <0, 1, 0> } uv_vectors { 3, <1, 0>, "
        "<0.5, 0.25>, <0.5, 0> } face_indices { 1, <0, 1, 2> } uv_indices { 1, <2, 0, 1> } ";
    const std::string map = "image_map { png PNG }";
    for (const std::string& start : {mesh, mesh2})
        for (const std::string& look :
             {"pigment { uv_mapping " + map + " }", "pigment { " + map + " uv_mapping }",
              "texture { uv_mapping pigment { " + map + " } }",
              "uv_mapping pigment { " + map + " }"}) {
            const Scene scene = read(start + look + " scale 2 translate z }").scene;
            expect_at(scene, {0, 0, 1}, {0.5, 0});
            expect_at(scene, {1, 0, 1}, {0.75, 0});
            expect_at(scene, {0, 2, 1}, {0.5, 0.25});
        }
    const Scene scaled = read(mesh + "pigment { uv_mapping " + map + " scale 0.5 } }").scene;
    expect_at(scaled, {0, 1, 0}, {1, 0.5});
}

TEST(PovHoles, WhatIsNotEvaluatedIsSaid) {
    const Read shiny = read("box { 0, 1 pigment { image_map { png PNG } } finish { phong 1 } }");
    ASSERT_EQ(shiny.warnings.size(), 1u);
    EXPECT_NE(shiny.warnings[0].find("neither shine nor bend light"), std::string::npos);
}

/// Returns the picture that the mesh's material shows, directly or by a stop of its texture.
ImageTexture picture_of(const Scene& scene, uint32_t material) {
    const Texture& texture =
        scene.textures.at(scene.materials.at(material).texture.value().texture);
    return texture.image ? *texture.image
                         : scene.textures.at(texture.stops.at(0).texture).image.value();
}

TEST(PovHoles, AreTransparentWhereTheyAreNotCut) {
    const std::string map = "image_map { png PNG }";
    for (const std::string& text :
         {"sphere { 0, 1 pigment { uv_mapping " + map + " } }",
          "box { 0, 1 pigment { bozo pigment_map { [0 " + map + "] [1 rgb 1] } } }",
          "box { 0, 1 texture { pigment { rgb x } } texture { pigment { " + map + " } } }",
          std::string("box { 0, 1 pigment { image_map { png PNG once } turbulence 0.2 } }")}) {
        const Read found = read(text);
        EXPECT_TRUE(found.warnings.empty()) << text;
        EXPECT_EQ(found.scene.meshes[0].cutout, kNone) << text;
        EXPECT_TRUE(picture_of(found.scene, found.scene.meshes[0].material).is_transparent) << text;
        EXPECT_EQ(found.scene.materials[found.scene.meshes[0].material].transmission, 1) << text;
    }
    const Read once = read("box { 0, 1 texture { pigment { rgb x } } texture { pigment { image_map "
                           "{ png OPAQUE once } } } }");
    const ImageTexture decal = picture_of(once.scene, once.scene.meshes[0].material);
    EXPECT_TRUE(decal.is_transparent) << "around it";
    EXPECT_EQ(decal.beyond_s, Beyond::Nothing);
    const Read mix = read("box { 0, 1 texture { checker texture { pigment { " + map +
                          " } } texture { pigment { rgb x } } } }");
    EXPECT_EQ(mix.scene.meshes[0].cutout, kNone) << "only a part of it has holes";
}

TEST(PovHoles, AreFilledByALayerBelow) {
    const Read found =
        read("box { 0, 1 texture { pigment { rgb x } } texture { pigment { image_map "
             "{ png PNG } } } }");
    EXPECT_EQ(found.scene.meshes[0].cutout, kNone);
    const Material& upper = found.scene.materials[found.scene.meshes[0].material];
    ASSERT_LT(upper.under, found.scene.materials.size());
    EXPECT_EQ(found.scene.materials[upper.under].color, vec3(1, 0, 0));
    EXPECT_EQ(found.scene.materials[upper.under].transmission, 0);
}

TEST(PovHoles, AreOfOneMeshWhereThePictureIsOne) {
    const Scene scene =
        read("#declare P = pigment { image_map { png PNG } } box { 0, 1 pigment { P "
             "} } box { 2, 3 pigment { P scale 2 } }")
            .scene;
    EXPECT_EQ(scene.cutouts.size(), 1u);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].uv.size(), 72u);
}

} // namespace
} // namespace ovc::pov
