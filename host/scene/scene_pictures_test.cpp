// SPDX-License-Identifier: Apache-2.0
#include "host/scene/scene_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace ovc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Scene scene_with(const std::vector<std::string>& files) {
    Scene scene;
    scene.name = "quilt";
    for (const std::string& file : files) {
        Texture texture;
        texture.kind = TextureKind::Image;
        texture.image = ImageTexture{.picture = uint32_t(scene.pictures.size())};
        scene.textures.push_back(texture);
        scene.pictures.push_back({file, "quilt.pbrt:3:7", {}});
    }
    return scene;
}

class Notes {
public:
    LogSink log() {
        return [this](LogLevel, const std::string& text) { all.push_back(text); };
    }
    std::vector<std::string> all;
};

/// A picture of one row, a red and a green texel.
class RedAndGreen {
public:
    RedAndGreen()
        : path(fs::temp_directory_path() /
               ("overcast-pictures-" + std::to_string(getpid()) + ".ppm")) {
        const char bytes[] = {'\xff', 0, 0, 0, '\xff', 0};
        std::ofstream(path, std::ios::binary) << "P6\n2 1\n255\n" << std::string(bytes, 6);
    }
    ~RedAndGreen() { fs::remove(path); }
    RedAndGreen(const RedAndGreen&) = delete;

    const fs::path path;
};

bool has_library() {
    ScenePictures pictures({}, LogSink());
    Scene scene = scene_with({"/nowhere.png"});
    (void)pictures.open(scene);
    return scene.omissions.empty() || scene.omissions[0].sentence.find(".so") == std::string::npos;
}

} // namespace

TEST(ScenePictures, GiveTexturesTheirColors) {
    if (!has_library())
        GTEST_SKIP() << "libovercast-textures.so is not built";
    const RedAndGreen picture;
    Notes notes;
    ScenePictures pictures({}, notes.log());
    Scene scene = scene_with({picture.path.string()});
    scene.textures[0].image->filter = TexelFilter::Nearest;
    ASSERT_TRUE(pictures.open(scene));
    EXPECT_EQ(color_at(*scene.textures[0].image, {0.25, 0.5, 0}, {}).rgb, vec3(1, 0, 0));
    // Far from 0, where floats hold whole numbers alone.
    EXPECT_EQ(color_at(*scene.textures[0].image, {1e9 + 0.75, 0.5, 0}, {}).rgb, vec3(0, 1, 0));
    ASSERT_TRUE(pictures.check(scene));
    EXPECT_TRUE(notes.all.empty());
    EXPECT_TRUE(scene.omissions.empty());
}

TEST(ScenePictures, CountPerMeasureWhereTheirTexturesSaySo) {
    if (!has_library())
        GTEST_SKIP() << "libovercast-textures.so is not built";
    const RedAndGreen picture;
    ScenePictures pictures({}, LogSink());
    Scene scene = scene_with({picture.path.string(), picture.path.string()});
    for (Texture& texture : scene.textures)
        texture.image->filter = TexelFilter::Nearest;
    scene.textures[1].image->per = ImageTexture::Measure::Mean;
    for (int again = 0; again < 2; ++again) {
        ASSERT_TRUE(pictures.open(scene));
        EXPECT_EQ(color_at(*scene.textures[0].image, {0.25, 0.5, 0}, {}).rgb, vec3(1, 0, 0));
        EXPECT_NEAR(color_at(*scene.textures[1].image, {0.25, 0.5, 0}, {}).rgb.x,
                    2 / (0.2126 + 0.7152), 1e-5);
    }
}

TEST(ScenePictures, WarnOnceOfEachThatIsMissing) {
    if (!has_library())
        GTEST_SKIP() << "libovercast-textures.so is not built";
    Notes notes;
    ScenePictures pictures({}, notes.log());
    Scene scene = scene_with({"/no/a.png", "/no/b.png", "/no/a.png"});
    ASSERT_TRUE(pictures.open(scene));
    ASSERT_TRUE(pictures.open(scene)) << "for another moment";
    EXPECT_EQ(notes.all,
              (std::vector<std::string>{
                  "quilt.pbrt:3:7: the picture '/no/a.png' is not shown: there is no such file",
                  "quilt.pbrt:3:7: the picture '/no/b.png' is not shown: there is no such file"}));
    EXPECT_EQ(scene.omissions,
              (std::vector<Omission>{{"pictures that are missing or cannot be read", 2}}));
    EXPECT_EQ(color_at(*scene.textures[0].image, dvec3(0), {}).rgb, vec3(0.5f));
}

TEST(ScenePictures, ThatAreMissingAreAnErrorIfStrict) {
    if (!has_library())
        GTEST_SKIP() << "libovercast-textures.so is not built";
    ScenePictures pictures({.strict = true}, LogSink());
    Scene scene = scene_with({"/no/a.png"});
    const Result<Done> done = pictures.open(scene);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message,
              "quilt.pbrt:3:7: the picture '/no/a.png' is not shown: there is no such file");
}

TEST(ScenePictures, WarnOfOneThatBreaksOffWhereItIsLookedAt) {
    if (!has_library())
        GTEST_SKIP() << "libovercast-textures.so is not built";
    const RedAndGreen picture;
    fs::resize_file(picture.path, fs::file_size(picture.path) - 4);
    Notes notes;
    ScenePictures pictures({}, notes.log());
    Scene scene = scene_with({picture.path.string()});
    ASSERT_TRUE(pictures.open(scene));
    const TransparentColor color = color_at(*scene.textures[0].image, dvec3(0), {});
    EXPECT_EQ(color.rgb, vec3(0.5f)) << "that stands for it, whether it opened or not";
    ASSERT_TRUE(pictures.check(scene));
    ASSERT_EQ(notes.all.size(), 1u);
    EXPECT_THAT(notes.all[0], HasSubstr("is not shown: "));
    EXPECT_EQ(scene.omissions.size(), 1u);
}

TEST(ScenePictures, NeedNoLibraryWithoutTextures) {
    ScenePictures pictures({.strict = true, .library = "libmissing.so"}, LogSink());
    Scene scene;
    EXPECT_TRUE(pictures.open(scene));
}

TEST(ScenePictures, SayWhichLibraryIsMissing) {
    Notes notes;
    ScenePictures pictures({.library = "libmissing.so"}, notes.log());
    Scene scene = scene_with({"a.png", "b.png"});
    ASSERT_TRUE(pictures.open(scene));
    ASSERT_EQ(notes.all.size(), 1u);
    EXPECT_THAT(notes.all[0], HasSubstr("quilt: its 2 pictures are not shown"));
    EXPECT_THAT(notes.all[0], HasSubstr("libmissing.so"));
    EXPECT_THAT(notes.all[0], HasSubstr("libopenimageio-dev"));
    ASSERT_EQ(scene.omissions.size(), 1u);
    EXPECT_EQ(scene.omissions[0].count, 2u);
    EXPECT_EQ(color_at(*scene.textures[0].image, dvec3(0), {}).rgb, vec3(0.5f));
}

} // namespace ovc
