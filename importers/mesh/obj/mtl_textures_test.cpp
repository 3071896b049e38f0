// SPDX-License-Identifier: Apache-2.0
#include "importers/mesh/obj/mtl_textures.h"

#include "importers/importer.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <random>

namespace ovc {
namespace {

using Channel = ImageTexture::Channel;

MtlTexture parsed(std::string_view text) {
    return parse_mtl_texture("map_Kd", text, 7);
}

TEST(MtlTextures, OptionsStandBeforeOrBehindANameWithBlanks) {
    const MtlTexture texture = parsed(
        "-o 0.1 -s 2 3 1 -t 0.5 0.5 0.5 -blendu on -texres 512 wood floor.png -bm 1.5 -clamp on");
    EXPECT_EQ(texture.file, "wood floor.png");
    EXPECT_EQ(texture.keyword, "map_kd");
    EXPECT_EQ(texture.line, 7u);
    EXPECT_EQ(texture.offset, dvec2(0.1, 0));
    EXPECT_EQ(texture.scale, dvec2(2, 3));
    EXPECT_EQ(texture.bump, 1.5);
    EXPECT_TRUE(texture.clamp);
    const MtlTexture other = parsed("-mm 0.25 0.5 -imfchan r -type sphere a.tga");
    EXPECT_EQ(other.file, "a.tga");
    EXPECT_EQ(other.base, 0.25);
    EXPECT_EQ(other.gain, 0.5);
    EXPECT_EQ(other.channel, 'r');
}

TEST(MtlTextures, BrokenOptionsTakeNoWordsOfOthers) {
    EXPECT_EQ(parsed("-o -s 2 a.png").scale, dvec2(2, 1));
    EXPECT_EQ(parsed("-mm nan x.png").file, "nan x.png");
    EXPECT_EQ(parsed("-bm").file, "");
    EXPECT_EQ(parsed("").file, "");
    EXPECT_EQ(parsed("-").file, "-");
    EXPECT_EQ(parsed("-unknown 3 a.png").file, "-unknown 3 a.png");
}

/// Returns the scene of two triangles with this material.
Scene scene_of(const TestFolder& folder, const std::string& statements,
               const std::string& more = {}) {
    folder.write("m.mtl", "newmtl m\n" + statements);
    auto scene = load(folder.write(
        "m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                 "vt 0.25 0.75 9\n" +
                     more + "usemtl m\nf 1/1 2/2 3/3 4/-1\n"));
    EXPECT_TRUE(scene) << scene.error().message;
    return std::move(*scene);
}

TEST(MtlTextures, AColorMultipliesKdAndKeepsTextureCoordinates) {
    const TestFolder folder;
    const Scene scene =
        scene_of(folder, "Kd 0.5 1 0.25\nmap_Kd -s 2 2 -o 0.5 0 -mm 0.25 0.5 tex\\wood.png\n");
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].uv,
              (std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0.25f, 0.75f}}));
    EXPECT_EQ(scene.meshes[0].texture_coordinates_left_out, 0u);
    const Material& material = scene.materials[scene.meshes[0].material];
    ASSERT_TRUE(material.texture);
    const ImageTexture& image = *scene.textures[material.texture->texture].image;
    EXPECT_EQ(image.scale, vec3(0.25f, 0.5f, 0.125f));
    EXPECT_EQ(image.offset, vec3(0.125f, 0.25f, 0.0625f));
    EXPECT_EQ(image.otherwise.rgb, vec3(0.5f, 1, 0.25f));
    EXPECT_EQ(image.to_picture[0], dvec3(2, 0, 0.5));
    EXPECT_EQ(image.to_picture[1], dvec3(0, 2, 0));
    EXPECT_EQ(image.gamma, 0);
    ASSERT_EQ(scene.pictures.size(), 1u);
    EXPECT_THAT(scene.pictures[0].file, testing::EndsWith("/tex/wood.png"));
    EXPECT_THAT(scene.pictures[0].asked_for_at, testing::EndsWith("m.mtl, line 3"));
}

TEST(MtlTextures, BlackKdLeavesThePictureAlone) {
    const TestFolder folder;
    const Scene scene = scene_of(folder, "Kd 0 0 0\nmap_Kd a.png\n");
    EXPECT_EQ(scene.textures[0].image->scale, vec3(1));
}

TEST(MtlTextures, KeMakesLight) {
    const TestFolder folder;
    const auto material = [&](const std::string& statements) {
        const Scene scene = scene_of(folder, statements);
        return scene.materials[scene.meshes[0].material];
    };
    const Material lamp = material("Kd 0.5\nKe 17 12 4\n");
    ASSERT_TRUE(lamp.optics);
    EXPECT_EQ(lamp.optics->emission, vec3(17, 12, 4)) << "brighter than white";
    EXPECT_EQ(lamp.optics->diffuse, vec3(0.5f));
    EXPECT_TRUE(lamp.optics->two_sided);
    EXPECT_EQ(material("Ke 1\nKs 0.25\nillum 3\n").optics->reflection, vec3(0.25f));
    EXPECT_FALSE(material("Ke 0 0 0\n").optics);
    const Material glass = material("Kd 1 0.5 0\nKe 1\nd 0.25\nillum 4\nTf 1 0 0\n");
    ASSERT_TRUE(glass.optics);
    EXPECT_EQ(glass.optics->emission, vec3(1));
    EXPECT_EQ(glass.optics->diffuse, 0.25f * vec3(1, 0.5f, 0));
    EXPECT_EQ(glass.optics->through, 0.75f * vec3(1, 0, 0));
    EXPECT_FALSE(material("Ke 1\nKs 0.5\nd 0.5\nillum 4\n").optics) << "left out, which is said";
    const Material shown = material("Ke 0 0 0\nmap_Ke a.png\nmap_Ks b.png\n");
    EXPECT_EQ(shown.optics->emission, vec3(1)) << "black leaves the picture alone";
    ASSERT_TRUE(shown.maps);
    EXPECT_NE(shown.maps->emission, kNone);
    EXPECT_NE(shown.maps->reflection, kNone);
}

TEST(MtlTextures, EachStatementChangesItsPart) {
    const TestFolder folder;
    const Scene scene = scene_of(folder, "Ks 0.5\nillum 3\nmap_Ks a.png\nmap_d a.png\n"
                                         "map_Bump -bm 0.5 -imfchan g b.png\n");
    const Material& material = scene.materials[scene.meshes[0].material];
    ASSERT_TRUE(material.maps);
    EXPECT_EQ(scene.textures[material.maps->reflection].image->picture, 0u);
    ASSERT_EQ(scene.cutouts.size(), 1u);
    EXPECT_EQ(scene.meshes[0].cutout, 0u);
    const ImageTexture& mask = *scene.textures[scene.cutouts[0].texture].image;
    EXPECT_EQ(mask.picture, 0u) << "a file is one picture, however often it is named";
    EXPECT_EQ(mask.channel, Channel::Mask);
    EXPECT_EQ(mask.gamma, 1);
    ASSERT_TRUE(material.normal_map);
    EXPECT_EQ(material.normal_map->kind, NormalMap::Kind::Texels);
    EXPECT_EQ(material.normal_map->scale, 0.5);
    const ImageTexture& bump = *scene.textures[material.normal_map->texture].image;
    EXPECT_EQ(bump.picture, 1u);
    EXPECT_EQ(bump.channel, Channel::Green);
    const Scene with_normals = scene_of(folder, "norm n.png\n");
    EXPECT_EQ(with_normals.materials[1].normal_map->kind, NormalMap::Kind::Tangent);
}

TEST(MtlTextures, TextureCoordinatesAreKeptWhereAskedForAlone) {
    const TestFolder folder;
    const Scene plain = scene_of(folder, "Kd 1 0 0\nnewmtl unused\nmap_Kd a.png\n");
    EXPECT_TRUE(plain.meshes[0].uv.empty());
    EXPECT_EQ(plain.meshes[0].texture_coordinates_left_out, 6u);
    EXPECT_TRUE(plain.pictures.empty());
}

TEST(MtlTextures, WithoutTextureCoordinatesThereAreNoHoles) {
    const TestFolder folder;
    folder.write("m.mtl", "newmtl m\nmap_d a.png\n");
    const auto scene = load(folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n"
                                                  "usemtl m\nf 1 2 3\n"));
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->meshes[0].cutout, kNone);
}

/// Words of the format in any order, whole or cut, make no name that is not in the line and no
/// number that is none.
TEST(MtlTextures, AnyLineIsAStatement) {
    const char* const words[] = {"-o",    "-s", "-mm",  "-bm", "-clamp", "-imfchan",
                                 "on",    "1",  "-2e9", "x",   "inf",    "nan",
                                 "1e999", "-",  "\xff", "r",   "",       "\t"};
    for (uint32_t seed = 0; seed < 2000; ++seed) {
        std::mt19937 random(seed);
        std::string line;
        for (uint32_t i = random() % 9; i > 0; --i)
            line += std::string(words[random() % std::size(words)]) + " ";
        line.resize(line.size() - std::min<size_t>(line.size(), random() % 3));
        const MtlTexture texture = parse_mtl_texture("map_d", line, seed);
        EXPECT_NE(line.find(texture.file), line.npos) << seed;
        for (const double number : {texture.scale.x, texture.scale.y, texture.offset.x,
                                    texture.offset.y, texture.base, texture.gain, texture.bump})
            EXPECT_TRUE(std::isfinite(number)) << seed;
    }
}

TEST(MtlTextures, APictureThatWasMovedBesideItsLibraryIsFound) {
    const TestFolder folder;
    folder.write("wood.png", "x");
    const Scene scene = scene_of(folder, "map_Kd C:\\art\\wood.png\n");
    EXPECT_EQ(folder.plain(scene.pictures[0].file), "wood.png");
}

} // namespace
} // namespace ovc
