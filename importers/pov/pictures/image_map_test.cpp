// SPDX-License-Identifier: Apache-2.0
#include "core/texture/pattern.h"
#include "importers/png.h"
#include "importers/test_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
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
    EXPECT_TRUE(read_map("interpolate 2").warnings.empty());
    const ReadPov by_distance = read_map("interpolate 4");
    EXPECT_EQ(by_distance.image().filter, TexelFilter::Smooth);
    EXPECT_THAT(by_distance.warnings,
                testing::Contains(testing::HasSubstr("interpolate 4 of a picture is read as")));
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

/// Reads a scene beside a.png, which is red and blue, side by side.
ReadPov read_beside_picture(const std::string& text) {
    const TestFolder folder;
    folder.write("a.png", png_of(2, 1, {255, 0, 0, 255, 1, 0, 255, 255}));
    ReadPov read;
    Result<Scene> scene =
        load(folder.write("a.pov", "#version 3.7; global_settings { assumed_gamma 1 }\n" + text),
             gather(read.warnings));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (scene)
        read.scene = std::move(*scene);
    return read;
}

TEST(PovMaterialMap, RedsChooseTexturesModuloTheirNumber) {
    const ReadPov read = read_beside_picture(
        "sphere { 0, 1 texture { material_map { png \"a.png\" once texture { pigment { rgb 0 } } "
        "texture { pigment { rgb 1 } } texture { pigment { rgb x } } } } }");
    EXPECT_TRUE(read.warnings.empty());
    ASSERT_EQ(read.scene.pictures.size(), 1u);
    const std::vector<uint8_t>& bytes = read.scene.pictures[0].contents;
    const Result<Picture> picture = read_png(bytes);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->pixels[0][0] >> 8, 255 % 3);
    EXPECT_EQ(picture->pixels[1][0] >> 8, 1 % 3);
    ASSERT_TRUE(read.material().mix);
    const Texture& mix = read.scene.textures[read.material().mix->texture];
    EXPECT_EQ(mix.pattern.kind, Pattern::Kind::Function);
    // Between the two stops of each texture a value chooses it alone.
    ASSERT_EQ(mix.stops.size(), 6u);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(mix.stops[2 * i].texture, mix.stops[2 * i + 1].texture);
        EXPECT_LT(mix.stops[2 * i].at, double(i) / 255);
        EXPECT_GT(mix.stops[2 * i + 1].at, double(i) / 255);
    }
}

/// povray 3.7.0.10 draws a red of 3, of three textures, by the last of them.
TEST(PovMaterialMap, TheNumberOfTexturesChoosesTheLast) {
    const TestFolder folder;
    folder.write("a.png", png_of(3, 1, {3, 0, 0, 255, 4, 0, 0, 255, 6, 0, 0, 255}));
    const Result<Scene> scene = load(folder.write(
        "a.pov",
        "sphere { 0, 1 texture { material_map { png \"a.png\" texture { pigment { rgb 0 } } "
        "texture { pigment { rgb 1 } } texture { pigment { rgb x } } } } }"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->pictures.size(), 1u);
    const Result<Picture> picture = read_png(scene->pictures[0].contents);
    ASSERT_TRUE(picture);
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(picture->pixels[i][0] >> 8, (std::array{2, 1, 0})[i]);
}

/// As povray 3.7.0.10 prints them for function { pigment { image_map } } of a red of 128.
TEST(PovImageMap, HasTheGammaThatItsBlockSays) {
    const auto red = [](const std::string& settings, const std::string& gamma) {
        const TestFolder folder;
        folder.write("a.png", png_of(2, 1, {128, 64, 200, 255, 128, 64, 200, 255}));
        const Result<Scene> scene = load(
            folder.write("a.pov", settings + " sphere { 0, 1 pigment { image_map { png \"a.png\" " +
                                      gamma + " } } }"));
        EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
        const Material& m = scene->materials[scene->meshes.at(0).material];
        const double power = scene->textures[m.texture.value().texture].image->gamma;
        return power > 0 ? std::pow(128 / 255.0, power) : power;
    };
    const std::string linear = "#version 3.7; global_settings { assumed_gamma 1 }";
    const std::string old_screen = "#version 3.7; global_settings { assumed_gamma 2.2 }";
    EXPECT_NEAR(red(linear, "gamma 1"), 0.50196, 1e-5);
    EXPECT_NEAR(red(linear, "gamma 3"), 0.12648, 1e-5);
    EXPECT_EQ(red(linear, "gamma srgb"), 0);
    EXPECT_NEAR(red(old_screen, "gamma 1"), 0.73104, 1e-5);
    EXPECT_NEAR(red(old_screen, "gamma 3"), 0.39068, 1e-5);
    EXPECT_NEAR(red("", ""), 0.50196, 1e-5);
    EXPECT_NEAR(red("", "gamma 3"), 0.12648, 1e-5);
}

TEST(PovMaterialMap, WithoutItsPictureTheFirstTextureStands) {
    const ReadPov read = read_beside_picture(
        "sphere { 0, 1 texture { material_map { png \"b.png\" texture { pigment { rgb x } } "
        "texture { pigment { rgb 1 } } } } }");
    EXPECT_EQ(read.material().color, vec3(1, 0, 0));
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_NE(read.warnings[0].find("there is no file 'b.png': the material_map is left out"),
              std::string::npos)
        << read.warnings[0];
}

TEST(PovImagePattern, IsTheBrightnessOfCodes) {
    ReadPov read = read_beside_picture(
        "sphere { 0, 1 pigment { image_pattern { png \"a.png\" } color_map { [0 rgb 0] "
        "[1 rgb <2, 1, 0>] } } }");
    EXPECT_TRUE(read.warnings.empty());
    const Columns lookup;
    for (Texture& texture : read.scene.textures)
        if (texture.image)
            texture.image->lookup = &lookup;
    const PlacedTexture& placed = read.material().texture.value();
    const vec3 color =
        color_at(read.scene.textures, placed.texture, placed.at(dvec3(0.3, 0.7, 0))).rgb;
    const double gray = (0.297 * 76 + 0.589 * 179) / 255;
    EXPECT_NEAR(color.x, 2 * gray, 1e-5);
    EXPECT_NEAR(color.y, gray, 1e-5);
}

TEST(PovImagePattern, TakesThePictureThatItsFunctionNames) {
    const TestFolder folder;
    folder.write("a.png", png_of(1, 1, {255, 0, 0, 255}));
    folder.write("b.png", png_of(1, 1, {0, 255, 0, 255}));
    const std::string a = "pigment { image_map { png \"a.png\" } }";
    const std::string b = "pigment { image_map { png \"b.png\" } }";
    const Result<Scene> scene = load(folder.write(
        "a.pov", "#version 3.7;\n#declare G = function { " + b + " };\nsphere { 0, 1 " + a +
                     " }\nsphere { 3, 1 pigment { pigment_pattern { " + b.substr(10) +
                     " } }\nsphere { 6, 1 pigment { function { G(x, y, z).green } } }"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->pictures.size(), 2u);
    ASSERT_EQ(scene->materials.size(), 3u);
    for (size_t m = 0; m < 3; ++m) {
        const Texture& texture = scene->textures[scene->materials[m].texture.value().texture];
        uint32_t number = scene->materials[m].texture->texture;
        for (const FormulaStep& step : texture.pattern.formula.steps)
            number = step.kind == FormulaStep::Kind::Color ? step.index : number;
        const std::optional<ImageTexture>& image = scene->textures[number].image;
        ASSERT_TRUE(image);
        EXPECT_EQ(image->picture, m == 0 ? 0u : 1u);
        EXPECT_EQ(image->lookup, nullptr) << "whoever renders opens it";
    }
}

TEST(PovBumpMap, ItsSizeComesFromTheBlockOrFromBehindIt) {
    const auto bump_of = [](const std::string& normal) {
        return read_beside_picture("sphere { 0, 1 normal { " + normal + " } }").material().bump;
    };
    EXPECT_EQ(bump_of("bump_map { png \"a.png\" }")->amount, 0.5);
    EXPECT_EQ(bump_of("bump_map { png \"a.png\" bump_size 2 }")->amount, 2);
    EXPECT_EQ(bump_of("bump_map { png \"a.png\" bump_size 2 } bump_size 0.7")->amount, 0.7);
    EXPECT_EQ(bump_of("bump_map { png \"a.png\" } 0.7")->kind, Bump::Kind::Picture);
}

TEST(PovImageMap, WarpsAndTurbulenceMovePictures) {
    const ReadPov read = read_beside_picture(
        "#declare P = pigment { image_map { png \"a.png\" } warp { repeat x } scale 2 } "
        "sphere { 0, 1 pigment { P turbulence 0.3 octaves 2 } }");
    EXPECT_TRUE(read.warnings.empty());
    const Texture& texture = read.scene.textures.at(read.material().texture.value().texture);
    EXPECT_EQ(texture.kind, TextureKind::Image);
    ASSERT_EQ(texture.pattern.steps.size(), 3u);
    EXPECT_EQ(texture.pattern.steps[0].kind, TextureStep::Kind::Repeat);
    EXPECT_EQ(texture.pattern.steps[2].kind, TextureStep::Kind::Turbulence);
    EXPECT_EQ(texture.pattern.steps[2].rows[0], dvec4(0.3, 0.3, 0.3, 2));
    EXPECT_EQ(texture.pattern.steps[2].rows[1].y, 2);
}

TEST(PovUvMapping, MeshesKeepCoordinatesForPatternsOnThem) {
    const std::string mesh = "mesh { triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> } ";
    const std::string map = "checker rgb 0 rgb 1 scale 0.1";
    for (const std::string& more :
         {"pigment { uv_mapping " + map + " } }", "uv_mapping pigment { " + map + " } }"}) {
        const ReadPov read = read_beside_picture(mesh + more);
        EXPECT_TRUE(read.warnings.empty());
        EXPECT_EQ(read.scene.meshes.at(0).uv, (std::vector<vec2>{vec2(0), vec2(1, 0), vec2(0, 1)}));
        EXPECT_TRUE(read.scene.textures[read.material().texture.value().texture].on_uv);
    }
    EXPECT_TRUE(read_beside_picture(mesh + "pigment { " + map + " } }").scene.meshes[0].uv.empty());
    const ReadPov sphere =
        read_beside_picture("sphere { 0, 1 pigment { uv_mapping " + map + " } }");
    EXPECT_TRUE(sphere.warnings.empty());
    EXPECT_FALSE(sphere.scene.textures[sphere.material().texture.value().texture].on_uv)
        << "they follow from the place";
    const std::string lathe =
        "lathe { linear_spline 2, <1, 0>, <1, 1> pigment { uv_mapping " + map + " } } ";
    const ReadPov turned = read_beside_picture(lathe);
    EXPECT_TRUE(turned.warnings.empty());
    for (const vec2& uv : turned.scene.meshes.at(0).uv)
        EXPECT_TRUE((uv.y == 0 || uv.y == 1) && uv.x >= 0 && uv.x <= 1);
    EXPECT_FALSE(turned.scene.meshes[0].uv.empty());
    EXPECT_EQ(read_beside_picture("intersection { " + lathe + "sphere { 0, 9 } }").warnings.size(),
              1u);
    const ReadPov patch = read_beside_picture(
        "bicubic_patch { type 1 uv_vectors <0, 0> <2, 0> <2, 3> <0, 3> " +
        std::string("0 x 2*x 3*x y <1,1,0> <2,1,0> <3,1,0> 2*y <1,2,0> <2,2,0> <3,2,0> ") +
        "3*y <1,3,0> <2,3,0> <3,3,0> pigment { uv_mapping " + map + " } }");
    EXPECT_EQ(patch.scene.meshes.at(0).uv.at(0), vec2(0));
    float largest = 0;
    for (const vec2& uv : patch.scene.meshes[0].uv)
        largest = std::max(largest, uv.x + 10 * uv.y);
    EXPECT_EQ(largest, 32) << "the third corner";
}

} // namespace
} // namespace ovc
