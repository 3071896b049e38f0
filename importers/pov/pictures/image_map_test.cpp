// SPDX-License-Identifier: Apache-2.0
#include "core/texture/pattern.h"
#include "importers/test_files.h"

#include <cmath>

namespace ovc {
namespace {

/// A picture of 256 x 256 texels whose red is the column and whose green is the row from below.
class Columns final : public ImageLookup {
public:
    vec4 color(const PictureArea& area) const override {
        const auto texel = [](double x) {
            return float(std::floor((x - std::floor(x)) * 256) / 255);
        };
        return {texel(area.st.x), texel(area.st.y), 0, 1};
    }
    dvec2 size() const override { return dvec2(256); }
    bool has_opacity() const override { return false; }
};

struct ReadPov {
    Scene scene;
    std::vector<std::string> warnings;

    const Material& material() const { return scene.materials[scene.meshes.at(0).material]; }
    const ImageTexture& image() const {
        return scene.textures[material().texture.value().texture].image.value();
    }
};

ReadPov read_map(const std::string& map, const std::string& more = {}) {
    const TestFolder folder;
    folder.write("a.png", png_of(2, 1, {255, 0, 0, 255, 0, 0, 255, 255}));
    ReadPov read;
    Result<Scene> scene = load(
        folder.write("a.pov", "#version 3.7; global_settings { assumed_gamma 1 }\nsphere { 0, 1 "
                              "pigment { image_map { png \"a.png\" " +
                                  map + " } " + more + " } }"),
        gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    return read;
}

/// Columns and rows, as povray 3.7.0.10 prints them for function { pigment { image_map } }.
struct AskedTexels {
    dvec3 at;
    int type;
    int column, row;
};

constexpr AskedTexels kAskedTexels[] = {
    {{0.3, 0.7, 0.15}, 0, 76, 179},     {{-0.2, 0.35, -0.45}, 0, 204, 89},
    {{0.3, 0.7, 0.15}, 1, 18, 219},     {{0.61, 0.42, -5.9}, 1, 196, 133},
    {{-0.2, 0.35, -0.45}, 1, 174, 178}, {{1.1, -0.3, 0.2}, 1, 7, 106},
    {{-1.7, 0.2, 0.55}, 2, 115, 51},    {{0.5, -0.2, 0.4}, 2, 27, 204},
    {{0.3, 0.7, 0.15}, 5, 18, 222},     {{0.61, 0.42, -5.9}, 5, 196, 131},
    {{1.1, -0.3, 0.2}, 5, 7, 79},       {{0.5, -0.2, 0.4}, 5, 27, 20}};

TEST(PovImageMap, LiesWherePovrayPutsIt) {
    const Columns lookup;
    for (const AskedTexels& asked : kAskedTexels) {
        ReadPov read = read_map("map_type " + std::to_string(asked.type));
        EXPECT_TRUE(read.warnings.empty());
        for (Texture& texture : read.scene.textures)
            texture.image->lookup = &lookup;
        const PlacedTexture& placed = read.material().texture.value();
        const vec3 color =
            color_at(read.scene.textures, placed.texture, placed.at(asked.at)).rgb * 255.0f;
        EXPECT_NEAR(color.x, asked.column, 0.01) << asked.type;
        EXPECT_NEAR(color.y, asked.row, 0.01) << asked.type;
    }
}

TEST(PovImageMap, WordsChangeHowItIsShown) {
    EXPECT_EQ(read_map("").image().filter, TexelFilter::Nearest);
    EXPECT_EQ(read_map("").image().beyond_s, Beyond::Repeat);
    EXPECT_EQ(read_map("").image().gamma, 0);
    EXPECT_EQ(read_map("interpolate 2").image().filter, TexelFilter::Smooth);
    EXPECT_EQ(read_map("once map_type 1").image().beyond_t, Beyond::Nothing);
    const ReadPov clear = read_map("filter all 0.25 transmit all 0.5 map_type 1");
    EXPECT_EQ(clear.image().filter_all, 0.25f);
    EXPECT_EQ(clear.image().transmit_all, 0.5f);
    EXPECT_GT(clear.material().transmission, 0);
    EXPECT_EQ(clear.image().otherwise.rgb, vec3(0.5f, 0, 0.5f)) << "the average";
}

TEST(PovImageMap, IsMovedWithItsPigment) {
    const Columns lookup;
    ReadPov read = read_map("", "scale 2 translate x");
    for (Texture& texture : read.scene.textures)
        texture.image->lookup = &lookup;
    const PlacedTexture& placed = read.material().texture.value();
    const vec3 color =
        color_at(read.scene.textures, placed.texture, placed.at(dvec3(1.5, 1, 0))).rgb;
    EXPECT_NEAR(color.x, 64 / 255.0, 1e-5);
    EXPECT_NEAR(color.y, 128 / 255.0, 1e-5);
}

TEST(PovImageMap, AnotherPigmentTakesItsPlace) {
    const ReadPov read = read_map("", "color rgb <0, 1, 0>");
    EXPECT_FALSE(read.material().texture);
    EXPECT_EQ(read.material().color, vec3(0, 1, 0));
    EXPECT_TRUE(read.scene.pictures.empty());
}

} // namespace
} // namespace ovc
