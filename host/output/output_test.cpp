// SPDX-License-Identifier: Apache-2.0
// Tests that files appear whole or not at all, and that errors come before anything is rendered.
#include "host/output/output.h"

#include "host/diff/channels.h"
#include "tests/temp_folder.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <string>

namespace ovc {

namespace fs = std::filesystem;

class Output : public testing::Test {
protected:
    test::TempFolder folder_;
};

TEST_F(Output, ReplacesAFileWhole) {
    ASSERT_TRUE(save_text("old", folder_ / "a.json"));
    ASSERT_TRUE(save_text("new", folder_ / "a.json"));
    EXPECT_EQ(folder_.read("a.json"), "new");
    EXPECT_EQ(folder_.file_count(), 1u);
}

TEST_F(Output, LeavesLinksAndDevicesWhatTheyAre) {
    ASSERT_TRUE(save_text("old", folder_ / "real.png"));
    fs::create_symlink("real.png", folder_ / "link.png");
    fs::create_symlink("/dev/null", folder_ / "null.exr");
    ASSERT_TRUE(save_image(Image(2, 2), folder_ / "link.png"));
    ASSERT_TRUE(save_image(Image(2, 2), folder_ / "null.exr"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
    EXPECT_EQ(folder_.read("real.png").substr(1, 3), "PNG");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(folder_.file_count(), 3u);
}

TEST_F(Output, NoTwoFilesAreTheSame) {
    ASSERT_TRUE(save_text("", folder_ / "a"));
    fs::create_symlink("a", folder_ / "link");
    const NamedFile twice[] = {{"input", folder_ / "a"}, {"output", folder_ / "link"}};
    EXPECT_EQ(check_distinct(twice).error().message,
              "the input file '" + (folder_ / "a").string() + "' and the output file '" +
                  (folder_ / "link").string() + "' are the same file");
    const NamedFile once[] = {{"input", folder_ / "a"}, {"output", folder_ / "b"}};
    EXPECT_TRUE(check_distinct(once));
}

TEST_F(Output, IsCheckedBeforehand) {
    EXPECT_TRUE(check_image_output(folder_ / "a.png"));
    EXPECT_TRUE(check_image_output(folder_ / "a.EXR"));
    EXPECT_EQ(check_image_output("a.jpg").error().message,
              "the output file 'a.jpg' ends in neither .png nor .exr");
    EXPECT_EQ(check_image_output("/no/such/a.png").error().message,
              "the output file /no/such/a.png: the folder does not exist");
    fs::create_directory(folder_ / "b.png");
    EXPECT_THAT(check_image_output(folder_ / "b.png").error().message,
                testing::HasSubstr("found a directory"));
    ASSERT_TRUE(save_text("", folder_ / "file"));
    EXPECT_THAT(check_image_output(folder_ / "file" / "a.png").error().message,
                testing::HasSubstr("is no folder"));
    EXPECT_THAT(check_writable("statistics", "").error().message, testing::HasSubstr("empty name"));
}

static Image unpleasant_image() {
    Image image(3, 2);
    image.pixels = {{0, 0.5f, 1, 1}, {-1, 2, 1e30f, 1}, {NAN, INFINITY, -INFINITY, 0},
                    vec4(0),         vec4(1),           vec4(0.2f)};
    return image;
}

TEST_F(Output, WritesBothFormatsTheSameEveryTime) {
    for (const char* name : {"a.png", "a.exr"}) {
        ASSERT_TRUE(save_image(unpleasant_image(), folder_ / name));
        const std::string first = folder_.read(name);
        ASSERT_TRUE(save_image(unpleasant_image(), folder_ / name));
        EXPECT_EQ(folder_.read(name), first);
        EXPECT_GT(first.size(), 50u);
    }
    EXPECT_EQ(folder_.read("a.png").substr(1, 3), "PNG");
    EXPECT_EQ(folder_.read("a.exr").substr(0, 4), "\x76\x2f\x31\x01");
    EXPECT_EQ(folder_.file_count(), 2u);
}

TEST_F(Output, NeedsAFewRowsAtOnce) {
    constexpr uint32_t kWidth = 7, kHeight = 203;
    Image image(kWidth, kHeight);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = vec4(float(i), 1 / float(i + 1), 0.5f, 1);
    size_t most = 0, all = 0; // of an image that small a thread asks alone
    const PixelSource source(kWidth, kHeight, [&](size_t first, std::span<vec4> pixels) {
        std::copy_n(image.pixels.begin() + ptrdiff_t(first), pixels.size(), pixels.begin());
        most = std::max(most, pixels.size());
        all += pixels.size();
    });
    EXPECT_EQ(*encode_png(source), *encode_png(image));
    ASSERT_TRUE(save_image(source, folder_ / "a.exr"));
    EXPECT_EQ(all, 2 * image.pixels.size());
    EXPECT_LE(most, kWidth * kHeight / 3);
    const Result<Channels> read = read_channels(folder_ / "a.exr");
    ASSERT_TRUE(read);
    const Layer *red = read->find("R"), *green = read->find("G");
    ASSERT_TRUE(red && green);
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        EXPECT_EQ(std::bit_cast<float>(red->values[i]), image.pixels[i].r);
        EXPECT_EQ(std::bit_cast<float>(green->values[i]), image.pixels[i].g);
    }
}

TEST_F(Output, AnExrFileSaysHowItWasMade) {
    const FileContents contents{.notes = {{"overcast:version", "1.2.3"}, {"overcast:scene", ""}}};
    ASSERT_TRUE(save_image(unpleasant_image(), folder_ / "a.exr", contents));
    const Imf::InputFile file((folder_ / "a.exr").c_str());
    const auto* version =
        file.header().findTypedAttribute<Imf::StringAttribute>("overcast:version");
    ASSERT_TRUE(version);
    EXPECT_EQ(version->value(), "1.2.3");
    EXPECT_TRUE(file.header().findTypedAttribute<Imf::StringAttribute>("overcast:scene"));
}

TEST_F(Output, AFullDiskIsAnErrorThatSaysSo) {
    if (!fs::exists("/dev/full"))
        GTEST_SKIP() << "no /dev/full";
    for (const char* name : {"full.png", "full.exr"}) {
        fs::create_symlink("/dev/full", folder_ / name);
        EXPECT_EQ(save_image(unpleasant_image(), folder_ / name).error().message,
                  (folder_ / name).string() + ": cannot be written: No space left on device");
    }
}

} // namespace ovc
