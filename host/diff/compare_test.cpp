// SPDX-License-Identifier: Apache-2.0
// Tests of comparing pictures: the metrics against sums done by hand, and the limits.
#include "host/diff/compare.h"

#include "host/diff/verdict.h"
#include "tests/temp_folder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <sys/stat.h>
#include <thread>

namespace ovc {
namespace {

Layer reals(const char* name, std::initializer_list<float> values) {
    Layer layer{name, Layer::Type::Float, {}};
    for (const float value : values)
        layer.values.push_back(std::bit_cast<uint32_t>(value));
    return layer;
}

Channels four_pixels(std::vector<Layer> layers) {
    return {2, 2, Coding::Linear, std::move(layers)};
}

TEST(Compare, AddsUpEachLayer) {
    const Channels a = four_pixels({reals("R", {0, 0.5f, 1, 1}), reals("G", {0, 0, 0, 0}),
                                    reals("depth.Z", {1, INFINITY, NAN, 2})});
    const Channels b = four_pixels({reals("R", {0, 0.25f, 1, 0}), reals("G", {0, 0.25f, 0, 0}),
                                    reals("depth.Z", {1, INFINITY, NAN, 2})});
    const Comparison c = compare(a, b);
    ASSERT_EQ(c.layers.size(), 2u);
    EXPECT_EQ(c.layers[0].name, "color");
    EXPECT_EQ(c.layers[0].differing, 2u);
    const Errors& color = *c.layers[0].errors;
    EXPECT_EQ(color.max, 1);
    EXPECT_EQ(color.at.channel, "R");
    EXPECT_EQ(color.at.x, 1u);
    EXPECT_EQ(color.at.y, 1u);
    EXPECT_EQ(color.at.a, 1);
    EXPECT_EQ(color.at.b, 0);
    EXPECT_DOUBLE_EQ(color.mean, 1.5 / 8);
    EXPECT_DOUBLE_EQ(color.rmse, std::sqrt((1 + 2 * 0.0625) / 8));
    EXPECT_DOUBLE_EQ(color.psnr, 10 * std::log10(8 / 1.125));
    EXPECT_EQ(c.layers[1].name, "depth");
    EXPECT_EQ(c.layers[1].differing, 0u) << "equal infinities and NaNs are equal";
    EXPECT_EQ(c.layers[1].errors->psnr, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(c.flip) << "without B there is no color to see";
    EXPECT_EQ(c.over(0.25), 1u);
    EXPECT_EQ(c.over(0.2), 2u);
}

TEST(Compare, OnlyRedGreenAndBlueAreColor) {
    const Comparison c = compare(four_pixels({reals("R", {0, 0, 0, 0}), reals("Z", {1, 1, 1, 1})}),
                                 four_pixels({reals("R", {0, 0, 0, 0}), reals("Z", {9, 1, 1, 1})}));
    ASSERT_EQ(c.layers.size(), 2u);
    EXPECT_EQ(c.layers[0].name, "color");
    EXPECT_EQ(c.layers[0].differing, 0u);
    EXPECT_EQ(c.layers[1].name, "Z");
    EXPECT_EQ(c.layers[1].errors->mean, 2);
}

TEST(Compare, WholeNumbersMayStandInFloats) {
    const Layer whole{"id", Layer::Type::Uint, {7, 8, 9, 10}};
    const Layer floats = reals("id", {7, 8, 9, 11});
    for (const auto& [a, b] : {std::pair(whole, floats), std::pair(floats, whole)}) {
        const Comparison c = compare(four_pixels({a}), four_pixels({b}));
        EXPECT_EQ(c.layers[0].differing, 1u);
        EXPECT_FALSE(c.layers[0].errors);
        EXPECT_EQ(std::bit_cast<float>(c.differences[0].values[3]), 1);
    }
}

TEST(Compare, APngWithoutOpacityIsOpaque) {
    Channels a{2, 2, Coding::Srgb, {reals("R", {0, 0, 0, 0}), reals("A", {1, 1, 0.5f, 1})}};
    Channels b{2, 2, Coding::Srgb, {reals("R", {0, 0, 0, 0})}};
    add_opacity(a, b);
    const Comparison c = compare(a, b);
    EXPECT_EQ(c.only_in_a.size() + c.only_in_b.size(), 0u);
    EXPECT_EQ(judge(c, {}), Verdict::Failure);
}

TEST(Compare, WhatIsNoNumberIsInfinitelyFar) {
    const Comparison c = compare(four_pixels({reals("depth.Z", {1, 1, 1, 1})}),
                                 four_pixels({reals("depth.Z", {1, NAN, INFINITY, 1})}));
    EXPECT_EQ(c.layers[0].differing, 2u);
    EXPECT_EQ(c.layers[0].errors->max, std::numeric_limits<double>::infinity());
    EXPECT_EQ(c.over(1e30), 2u);
    EXPECT_NE(diff_json("a", "b", c, {}).find("\"max\": null"), std::string::npos);
}

TEST(Compare, WholeNumbersAreEqualOrNot) {
    const Channels a = four_pixels({{"id.prim", Layer::Type::Uint, {1, 2, 3, 0xffffffff}}});
    const Channels b = four_pixels({{"id.prim", Layer::Type::Uint, {1, 2, 4, 0}}});
    const Comparison c = compare(a, b);
    EXPECT_EQ(c.layers[0].name, "id");
    EXPECT_EQ(c.layers[0].differing, 2u);
    EXPECT_FALSE(c.layers[0].errors);
    EXPECT_EQ(c.over(1e30), 2u);
    EXPECT_EQ(std::bit_cast<float>(c.differences[0].values[2]), 1.0f);
}

TEST(Compare, NamesWhatOnlyOneFileHas) {
    const Channels a = four_pixels({reals("R", {0, 0, 0, 0}), reals("A", {1, 1, 1, 1})});
    const Channels b = four_pixels({reals("R", {0, 0, 0, 0}), reals("leaf", {1, 1, 1, 1})});
    const Comparison c = compare(a, b);
    EXPECT_THAT(c.only_in_a, testing::ElementsAre("A"));
    EXPECT_THAT(c.only_in_b, testing::ElementsAre("leaf"));
    EXPECT_THAT(diff_text("a.exr", "b.exr", c, {}),
                testing::HasSubstr("only in b.exr, and not compared: leaf"));
}

TEST(Compare, IsJudgedAsIdiffDoes) {
    const Channels a = four_pixels({reals("R", {0, 0, 0, 0})});
    const Comparison c = compare(a, four_pixels({reals("R", {0, 0, 0.1f, 0.5f})}));
    const auto verdict = [&](const Limit& fail, const Limit& warn) {
        return judge(c, {fail, warn});
    };
    EXPECT_EQ(verdict({}, {}), Verdict::Failure);
    EXPECT_EQ(verdict({0.2, 25}, {0.2, 25}), Verdict::Ok) << "25 % of the pixels, and no more";
    EXPECT_EQ(verdict({0.2, 25}, {0.05, 25}), Verdict::Warning);
    EXPECT_EQ(verdict({0.2, 24}, {}), Verdict::Failure);
    EXPECT_EQ(verdict({1, 0, 0.4}, {}), Verdict::Failure) << "one pixel too far";
    EXPECT_EQ(verdict({1, 0, 0.6}, {1, 0, 0.4}), Verdict::Warning);
    const Comparison same = compare(a, a);
    EXPECT_EQ(judge(same, {}), Verdict::Ok);
    const auto json = nlohmann::json::parse(diff_json("x", "y", c, {{0.2, 24}, {}}));
    EXPECT_EQ(json["verdict"], "failure");
    EXPECT_EQ(json["fail"]["pixels"], 1);
    EXPECT_EQ(json["fail"]["passed"], true);
    EXPECT_EQ(json["layers"][0]["errors"]["at"]["x"], 1);
}

TEST(Compare, ReadsWhatWasWritten) {
    const test::TempFolder folder;
    Image image(2, 2);
    image.pixels = {vec4(0, 0.25f, 1, 1), vec4(2), vec4(-1, 0, 0, 0.5f), vec4(0.1f)};
    const Layer id{"id.prim", Layer::Type::Uint, {7, 8, 9, 0xffffffff}};
    ASSERT_TRUE(save_image(image, folder / "a.exr", {.layers = {id}}));
    ASSERT_TRUE(save_image(image, folder / "a.png", {.png_bits = 16}));
    Result<Channels> exr = read_channels(folder / "a.exr");
    ASSERT_TRUE(exr) << exr.error().message;
    ASSERT_EQ(exr->size(), 4u);
    EXPECT_EQ(exr->find("id.prim")->values, id.values);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(std::bit_cast<float>(exr->find("G")->values[i]), image.pixels[i].g);
    const Result<Channels> png = read_channels(folder / "a.png");
    ASSERT_TRUE(png) << png.error().message;
    EXPECT_EQ(png->coding, Coding::Srgb);
    encode_srgb(*exr);
    EXPECT_LT(compare(*exr, *png).layers.at(0).errors->max, 1.0 / 65535)
        << "linear light as codes, clamped as the file is";
}

TEST(Compare, ReadsPipes) {
    const test::TempFolder folder;
    for (const char* name : {"a.exr", "a.png"}) {
        ASSERT_TRUE(save_image(Image(400, 300), folder / name));
        const std::string whole = folder.read(name);
        const std::filesystem::path pipe = folder / (std::string("pipe_") + name);
        ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
        std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << whole; });
        const Result<Channels> read = read_channels(pipe);
        writer.join();
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(read->size(), 120000u);
    }
}

TEST(Compare, KnowsWhereAPartOfAPictureBegins) {
    const test::TempFolder folder;
    const std::filesystem::path path = folder / "part.exr";
    Imf::Header header(Imath::Box2i({10, 20}, {109, 119}), Imath::Box2i({30, 50}, {33, 51}));
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    {
        std::vector<float> values(8, 0.5f);
        Imf::FrameBuffer frame;
        frame.insert("R", Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writePixels(2);
    }
    const Result<Channels> part = read_channels(path);
    ASSERT_TRUE(part) << part.error().message;
    EXPECT_EQ(part->x, 20);
    EXPECT_EQ(part->y, 30);
}

TEST(Compare, DamagedFilesAreRefused) {
    const test::TempFolder folder;
    for (const char* name : {"a.exr", "a.png"}) {
        ASSERT_TRUE(save_image(Image(40, 30), folder / name));
        const std::string whole = folder.read(name);
        for (size_t length = 0; length + 12 < whole.size(); ++length) {
            const Result<Channels> cut =
                read_channels(folder.write("cut", whole.substr(0, length)));
            ASSERT_FALSE(cut) << name << ", " << length;
            EXPECT_THAT(cut.error().message, testing::HasSubstr("cut: "));
        }
    }
    EXPECT_THAT(read_channels(folder / "none.png").error().message,
                testing::HasSubstr("none.png: cannot be read: No such file"));
    EXPECT_THAT(read_channels(folder).error().message, testing::HasSubstr("found a directory"));
}

} // namespace
} // namespace ovc
