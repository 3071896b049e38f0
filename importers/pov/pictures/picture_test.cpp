// SPDX-License-Identifier: Apache-2.0
// Tests that pictures of povray are read as they are in every format, that damaged ones are
// refused, and that height fields of them stand where povray's trace() meets them.
#include "importers/pov/pictures/picture.h"

#include "importers/pov/test_parse.h"
#include "importers/test_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace ovc::pov {
namespace {

constexpr const char* kPovRayPictures = "/usr/share/povray-3.7/include/";

/// Lets povray draw a picture of 24 x 16 pixels in one of its formats. Returns the picture's path,
/// or an empty path where povray is not installed.
std::filesystem::path drawn(const TestFolder& folder, const std::string& format,
                            const std::string& name) {
    const auto scene =
        folder.write("picture.pov", "#version 3.7; global_settings { assumed_gamma 1 }\n"
                                    "camera { orthographic location -z right x up y direction z }\n"
                                    "plane { z, 0 pigment { function { min(0.99, max(0, x + 0.5)) "
                                    "} color_map { [0 rgb 0] [1 rgb "
                                    "<1, 0.5, 0.2>] } } finish { ambient 1 diffuse 0 } }\n"
                                    "box { <-0.5, 0.25, -0.1>, <-0.25, 0.5, -0.1> pigment { rgb "
                                    "<0, 1, 0.5> } finish { ambient 1 "
                                    "diffuse 0 } }\n");
    const std::filesystem::path picture = folder / name;
    const std::string command =
        fmt::format("povray +I{} +O{} +W24 +H16 {} File_Gamma=1.0 -A -D -GA 2>/dev/null",
                    scene.string(), picture.string(), format);
    return std::system(command.c_str()) == 0 ? picture : std::filesystem::path();
}

TEST(PovPicture, IsWhatPovRayWroteInEveryFormat) {
    const TestFolder folder;
    const auto reference_path = drawn(folder, "+FP", "reference.ppm");
    if (reference_path.empty())
        GTEST_SKIP() << "povray is not installed";
    const Result<Picture> reference = read_picture(reference_path);
    ASSERT_TRUE(reference) << reference.error().message;
    ASSERT_EQ(reference->width, 24u);
    ASSERT_EQ(reference->height, 16u);
    // The green box stands in the upper left corner.
    EXPECT_LT(reference->pixels[0][0], 300);
    EXPECT_EQ(reference->pixels[0][1], 65535);
    const struct {
        const char* format;
        const char* name;
        int max_off;
    } cases[] = {{"+FP16", "a.ppm", 300}, {"+FN", "b.png", 0}, {"+FN16", "c.png", 300},
                 {"+FT", "d.tga", 0},     {"+FC", "e.tga", 0}, {"+FJ100", "f.jpg", 257 * 60}};
    for (const auto& c : cases) {
        const Result<Picture> picture = read_picture(drawn(folder, c.format, c.name));
        ASSERT_TRUE(picture) << picture.error().message;
        ASSERT_EQ(picture->width, 24u) << c.name;
        ASSERT_EQ(picture->height, 16u) << c.name;
        int most = 0;
        double sum = 0;
        for (size_t i = 0; i < picture->size(); ++i)
            for (size_t channel = 0; channel < 3; ++channel) {
                const int off =
                    std::abs(int(picture->pixels[i][channel]) - int(reference->pixels[i][channel]));
                most = std::max(most, off);
                sum += off;
            }
        EXPECT_LE(most, c.max_off) << c.name;
        EXPECT_LT(sum / double(3 * picture->size()), 800) << c.name;
    }
}

TEST(PovPicture, IsRefusedWhereverItEndsTooEarly) {
    const TestFolder folder;
    std::vector<std::string> files;
    for (const char* name : {"plasma2.png", "mtmand.pot"})
        if (const std::filesystem::path path = std::string(kPovRayPictures) + name;
            std::filesystem::exists(path))
            files.push_back(path.string());
    for (const auto& [format, name] :
         {std::pair("+FJ", "a.jpg"), {"+FC", "b.tga"}, {"+FP", "c.ppm"}})
        if (const auto path = drawn(folder, format, name); !path.empty())
            files.push_back(path.string());
    if (files.empty())
        GTEST_SKIP() << "povray is not installed";
    for (const std::string& file : files) {
        std::ifstream stream(file, std::ios::binary);
        const std::string whole((std::istreambuf_iterator<char>(stream)), {});
        const std::string extension = std::filesystem::path(file).extension().string();
        size_t refused = 0, count = 0;
        for (size_t length = 0; length < whole.size(); length += 1 + whole.size() / 300) {
            const auto cut = folder.write("cut" + extension, whole.substr(0, length));
            const Result<Picture> picture = read_picture(cut);
            ++count;
            refused += !picture;
            EXPECT_TRUE(!picture || picture->pixels.size() == picture->size());
            std::string changed = whole;
            changed[length] = char(~changed[length]);
            const auto other = read_picture(folder.write("changed" + extension, changed));
            EXPECT_TRUE(!other || other->pixels.size() == other->size());
        }
        // libjpeg makes up missing pixels, and povray's TGA ends with a table that nobody needs.
        EXPECT_GE(refused, extension == ".jpg"   ? 1
                           : extension == ".tga" ? count / 2
                                                 : count - 8)
            << file;
    }
}

/// Returns 255 times the height at which a ray straight down meets the field.
double height(const std::string& field, const std::string& x_z) {
    const Result<Scene> scene = parsed_scene("#declare A = height_field { " + field +
                                             " } #declare N = y; #declare P = trace(A, " + x_z +
                                             ", -y, N); box { -1e3, (1 + P.y) * <1, 1, 1> }");
    if (!scene) {
        ADD_FAILURE() << scene.error().message;
        return 0;
    }
    double hi = -1;
    for (const Triangle& t : triangles_of(scene))
        for (const dvec3& corner : t)
            hi = std::max(hi, corner.y);
    return 255 * (hi - 1);
}

/// povray 3.7.0.10 prints these heights.
TEST(PovHeightField, StandsWherePovRayHasIt) {
    const TestFolder folder;
    const std::string gray =
        "pgm \"" +
        folder.write("a.pgm", std::string("P5\n3 2\n255\n\x0a\x32\xc8\x64\x96\xfa")).string() +
        "\"";
    EXPECT_NEAR(height(gray, "<0.00001, 5, 0.00001>"), 100, 0.02);
    EXPECT_NEAR(height(gray, "<0.25, 5, 0.5>"), 80, 0.02);
    EXPECT_NEAR(height(gray, "<0.125, 5, 0.25>"), 90, 0.02);
    EXPECT_NEAR(height(gray, "<0.375, 5, 0.75>"), 65, 0.02);
    EXPECT_NEAR(height(gray, "<0.99999, 5, 0.99999>"), 200, 0.02);
    EXPECT_NEAR(height(gray + " smooth water_level 0.4", "<0.375, 5, 0.25>"), 115, 0.02);
    EXPECT_EQ(height(gray + " water_level 0.4", "<0.25, 5, 0.5>"), 0);
    EXPECT_NEAR(height(gray + " gamma 3", "<0.00001, 5, 0.00001>") / 255, std::pow(100 / 255.0, 3),
                1e-4);
    const std::string colors =
        "ppm \"" +
        folder
            .write("b.ppm", "P3\n3 2 # text\n255\n10 20 30 50 60 70 200 210 220 100 110 120 150 "
                            "160 170 250 251 252\n")
            .string() +
        "\"";
    EXPECT_NEAR(height(colors, "<0.25, 5, 0.5>"), 80.0377, 0.02);
    const std::string function = "function 3, 2 { x * 100 / 255 + y * 50 / 255 }";
    EXPECT_NEAR(height(function, "<0.25, 5, 0.5>"), 50, 0.02);
    EXPECT_NEAR(height(function, "<0.75, 5, 0.99999>"), 75, 0.02);
}

TEST(PovHeightField, TakesTheNumbersOfColors) {
    if (!std::filesystem::exists(std::string(kPovRayPictures) + "mtmand.pot"))
        GTEST_SKIP() << "povray's pictures are not installed";
    EXPECT_NEAR(height("png \"plasma3.png\"", "<0.0001, 5, 0.0001>"), 164.4738, 0.02);
    EXPECT_NEAR(height("png \"plasma3.png\"", "<0.5, 5, 0.5>"), 163.8574, 0.02);
    EXPECT_NEAR(height("gif \"mtmand.pot\"", "<0.0001, 5, 0.0001>"), 86.7356, 0.02);
    EXPECT_NEAR(height("gif \"mtmand.pot\"", "<0.5, 5, 0.5>"), 99.6094, 0.02);
}

TEST(PovImageMap, HasItsAverageColorWithoutThePicture) {
    const TestFolder folder;
    const auto picture = folder.write("a.ppm", "P3\n2 1\n255\n255 0 0 188 188 0\n");
    const Result<Scene> scene = parsed_scene("#version 3.7; global_settings { assumed_gamma 1 } "
                                             "sphere { 0, 1 pigment { image_map { ppm \"" +
                                             picture.string() + "\" once transmit all 0.25 } } }");
    ASSERT_TRUE(scene) << scene.error().message;
    const ovc::Material& material = scene->materials.at(0);
    EXPECT_NEAR(material.color.r, (1 + 0.5029) / 2, 0.001);
    EXPECT_NEAR(material.color.g, 0.5029 / 2, 0.001);
    EXPECT_NEAR(material.color.b, 0, 0.001);
    ASSERT_TRUE(material.texture);
    const ImageTexture& image = scene->textures[material.texture->texture].image.value();
    EXPECT_EQ(image.lookup, nullptr);
    EXPECT_NEAR(image.otherwise.rgb.g, 0.5029 / 2, 0.001);
    EXPECT_NEAR(image.otherwise.transmit, 0.25, 0.001);
}

} // namespace
} // namespace ovc::pov
