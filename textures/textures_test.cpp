// SPDX-License-Identifier: Apache-2.0
// Lookups of libovercast-textures.so against pixels written here, and against OpenImageIO itself.
#include "textures/overcast_textures.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/texture.h>
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;

const ovc_textures_api& api() {
    static const ovc_textures_api* const found = [] {
        void* library = dlopen(OVC_TEXTURES_LIBRARY, RTLD_NOW | RTLD_LOCAL);
        EXPECT_NE(library, nullptr) << dlerror();
        const auto get = reinterpret_cast<ovc_get_textures_function>(
            library ? dlsym(library, "ovc_get_textures") : nullptr);
        return get ? get(OVC_TEXTURES_VERSION) : nullptr;
    }();
    return *found;
}

class Cache {
public:
    explicit Cache(uint64_t bytes = uint64_t(16) << 20) : handle_(api().create(bytes)) {}
    ~Cache() { api().destroy(handle_); }
    Cache(const Cache&) = delete;

    /// Returns the picture's number; ~0 where it cannot be opened.
    uint32_t open(const fs::path& file, double gamma = 1) const {
        const std::string name = file.string();
        ovc_picture picture{sizeof(ovc_picture), name.c_str(), nullptr, 0, gamma, 0, 0, 0};
        uint32_t number = ~0u;
        return api().open(handle_, &picture, &number) ? number : ~0u;
    }

    std::vector<float> sample(uint32_t number, const ovc_texture_area& area) const {
        std::vector<float> rgba(4, -1);
        EXPECT_TRUE(api().sample(handle_, number, &area, rgba.data())) << api().last_error();
        return rgba;
    }

    ovc_textures handle() const { return handle_; }

private:
    const ovc_textures handle_;
};

ovc_texture_area point_at(float s, float t, uint32_t texels = OVC_TEXELS_NEAREST,
                          uint32_t wrap = OVC_WRAP_REPEAT) {
    return {s, t, {0, 0}, {0, 0}, wrap, wrap, texels};
}

/// Writes a picture and deletes it at the end.
class TestPicture {
public:
    TestPicture(const std::string& name, int width, int height, int channels, OIIO::TypeDesc type,
                const std::vector<float>& values)
        : path(fs::temp_directory_path() / ("overcast-" + std::to_string(getpid()) + name)) {
        OIIO::ImageSpec spec(width, height, channels, type);
        spec.attribute("oiio:UnassociatedAlpha", 1); // the values are those of the file
        if (channels % 2 == 0)
            spec.alpha_channel = channels - 1;
        OIIO::ImageBuf image(spec);
        EXPECT_EQ(values.size(), size_t(width * height * channels));
        image.set_pixels(OIIO::ROI(0, width, 0, height, 0, 1, 0, channels), OIIO::TypeFloat,
                         values.data());
        EXPECT_TRUE(image.write(path.string())) << image.geterror();
    }
    ~TestPicture() { fs::remove(path); }
    TestPicture(const TestPicture&) = delete;

    const fs::path path;
};

/// Returns values that are codes of 8 bits.
std::vector<float> noise(size_t count) {
    std::mt19937 random(1);
    std::vector<float> values(count);
    for (float& value : values)
        value = float(random() % 256) / 255.0f;
    return values;
}

float srgb_to_linear(float code) {
    return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

TEST(Textures, NearestTexelsAreThoseOfTheFileFromItsTopRowAtOne) {
    for (const char* name : {".png", ".tif", ".bmp", ".tga", ".exr"}) {
        const std::vector<float> values = noise(5 * 3 * 3);
        const TestPicture picture(
            name, 5, 3, 3, std::string(name) == ".exr" ? OIIO::TypeFloat : OIIO::TypeUInt8, values);
        const Cache cache;
        const uint32_t number = cache.open(picture.path);
        ASSERT_NE(number, ~0u) << name << ": " << api().last_error();
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 5; ++x) {
                const auto rgba = cache.sample(
                    number, point_at((float(x) + 0.5f) / 5, 1 - (float(y) + 0.5f) / 3));
                for (size_t c = 0; c < 3; ++c)
                    EXPECT_NEAR(rgba[c], values[size_t(y * 5 + x) * 3 + c], 3e-4) << name;
                EXPECT_EQ(rgba[3], 1) << name;
            }
    }
}

TEST(Textures, CodesBecomeLightAndOpacityDoesNot) {
    const TestPicture picture("alpha.png", 2, 1, 4, OIIO::TypeUInt8,
                              {0.4f, 0.6f, 0.8f, 0.2f, 1, 1, 1, 0});
    const Cache cache;
    const auto srgb = cache.sample(cache.open(picture.path, 0), point_at(0.25f, 0.5f));
    const auto power = cache.sample(cache.open(picture.path, 2), point_at(0.25f, 0.5f));
    const float codes[] = {0.4f, 0.6f, 0.8f};
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(srgb[c], srgb_to_linear(codes[c]), 1e-3);
        EXPECT_NEAR(power[c], codes[c] * codes[c], 1e-3);
    }
    EXPECT_NEAR(srgb[3], 0.2, 1e-3);
    const auto clear = cache.sample(cache.open(picture.path, 1), point_at(0.75f, 0.5f));
    EXPECT_EQ(clear, (std::vector<float>{1, 1, 1, 0})) << "the color of a clear texel stays";
}

TEST(Textures, GrayHasThreeEqualChannelsAndItsOpacity) {
    const TestPicture gray("gray.png", 1, 1, 1, OIIO::TypeUInt8, {0.6f});
    const TestPicture both("both.png", 1, 1, 2, OIIO::TypeUInt8, {0.4f, 0.8f});
    const Cache cache;
    const auto one = cache.sample(cache.open(gray.path), point_at(0.5f, 0.5f));
    const auto two = cache.sample(cache.open(both.path), point_at(0.5f, 0.5f));
    for (size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(one[c], 0.6, 1e-3);
        EXPECT_NEAR(two[c], 0.4, 1e-3);
    }
    EXPECT_EQ(one[3], 1);
    EXPECT_NEAR(two[3], 0.8, 1e-3);
}

TEST(Textures, WrapsAsAsked) {
    const TestPicture picture("wrap.png", 2, 1, 3, OIIO::TypeUInt8, {0, 0, 0, 1, 1, 1});
    const Cache cache;
    const uint32_t number = cache.open(picture.path);
    const auto at = [&](float s, uint32_t wrap) {
        return cache.sample(number, point_at(s, 0.5f, OVC_TEXELS_NEAREST, wrap));
    };
    EXPECT_EQ(at(1.25f, OVC_WRAP_REPEAT)[0], 0);
    EXPECT_EQ(at(1.25f, OVC_WRAP_CLAMP)[0], 1);
    EXPECT_EQ(at(1.25f, OVC_WRAP_MIRROR)[0], 1);
    EXPECT_EQ(at(-0.25f, OVC_WRAP_MIRROR)[0], 0);
    EXPECT_EQ(at(1.25f, OVC_WRAP_BLACK), (std::vector<float>{0, 0, 0, 0}));
    EXPECT_EQ(at(0.75f, OVC_WRAP_BLACK), (std::vector<float>{1, 1, 1, 1}));
}

/// The mean of black and white is half of the light, not the light of the middle code.
TEST(Textures, MeansAreOfLight) {
    std::vector<float> board;
    for (int i = 0; i < 64 * 64; ++i)
        board.insert(board.end(), 3, float((i % 64 + i / 64) % 2));
    const TestPicture picture("board.png", 64, 64, 3, OIIO::TypeUInt8, board);
    const Cache cache;
    const uint32_t number = cache.open(picture.path, 0);
    ovc_texture_area area = point_at(0.3f, 0.6f, OVC_TEXELS_MIPMAPS);
    area.a[0] = area.b[1] = 0.25f;
    EXPECT_NEAR(cache.sample(number, area)[1], 0.5, 0.01);
    const float half_way = 8.0f / 64;
    EXPECT_NEAR(cache.sample(number, point_at(half_way, half_way, OVC_TEXELS_SMOOTH))[1], 0.5,
                0.01);
}

/// The differential test: the same areas of a picture that maketx has made, by OpenImageIO itself.
TEST(Textures, AgreesWithATextureThatMaketxWouldMake) {
    const std::vector<float> values = noise(64 * 64 * 3);
    const TestPicture picture("source.exr", 64, 64, 3, OIIO::TypeFloat, values);
    const fs::path made = picture.path.string() + ".tx";
    const OIIO::ImageBuf source(picture.path.string());
    ASSERT_TRUE(OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, source,
                                                 made.string(), OIIO::ImageSpec()));
    OIIO::TextureSystem* const system = OIIO::TextureSystem::create(/* shared= */ false);
    OIIO::TextureOpt options;
    options.swrap = options.twrap = OIIO::TextureOpt::WrapPeriodic;
    options.interpmode = OIIO::TextureOpt::InterpBilinear;
    options.mipmode = OIIO::TextureOpt::MipModeAniso;
    const Cache cache;
    const uint32_t number = cache.open(picture.path);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> anywhere(-1, 2), side(-0.1f, 0.1f);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        ovc_texture_area area = point_at(anywhere(random), anywhere(random), OVC_TEXELS_MIPMAPS);
        for (float* const number_of_side : {&area.a[0], &area.a[1], &area.b[0], &area.b[1]})
            *number_of_side = i % 2 ? side(random) : 0.01f * side(random);
        float expected[3];
        ASSERT_TRUE(system->texture(OIIO::ustring(made.string()), options, area.s, 1 - area.t,
                                    area.a[0], -area.a[1], area.b[0], -area.b[1], 3, expected));
        const auto found = cache.sample(number, area);
        for (size_t c = 0; c < 3; ++c)
            worst = std::max(worst, double(std::abs(found[c] - expected[c])));
    }
    // A file of one level and one with mipmaps: both means are of 2 x 2 texels.
    EXPECT_LT(worst, 0.01);
    OIIO::TextureSystem::destroy(system);
    fs::remove(made);
}

TEST(Textures, ReadsAPictureThatLiesInMemory) {
    for (const char* name : {"memory.png", "memory.jpg"}) {
        const TestPicture picture(name, 16, 16, 3, OIIO::TypeUInt8,
                                  std::vector<float>(16 * 16 * 3, 0.6f));
        std::ifstream file(picture.path, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
        const Cache cache;
        ovc_picture asked{sizeof(ovc_picture), "model.glb", bytes.data(), bytes.size(), 1, 0, 0, 0};
        uint32_t number = 0;
        ASSERT_TRUE(api().open(cache.handle(), &asked, &number)) << name << api().last_error();
        EXPECT_EQ(asked.width, 16u);
        EXPECT_NEAR(cache.sample(number, point_at(0.5f, 0.5f))[1], 0.6, 0.01) << name;
    }
}

TEST(Textures, SaysWhyAPictureCannotBeRead) {
    const Cache cache;
    EXPECT_EQ(cache.open("/nowhere/at/all.png"), ~0u);
    EXPECT_STREQ(api().last_error(), "there is no such file");
    const TestPicture whole("cut.png", 64, 64, 3, OIIO::TypeUInt8, noise(64 * 64 * 3));
    fs::resize_file(whole.path, 20);
    EXPECT_EQ(cache.open(whole.path), ~0u);
    EXPECT_NE(std::string(api().last_error()), "");
    std::ofstream(whole.path) << "this is no picture";
    EXPECT_EQ(cache.open(whole.path), ~0u);
}

/// Damaged headers may claim any size. What is no regular file may have no end.
TEST(Textures, RefusesPicturesOfImpossibleSizesAndFilesWithoutEnd) {
    const Cache cache;
    const fs::path path =
        fs::temp_directory_path() / ("overcast-" + std::to_string(getpid()) + "huge.");
    const struct {
        const char* extension;
        const char* contents;
        const char* sentence;
    } cases[] = {
        {"pfm", "PF\n2000000000 2000000000\n-1.0\n", "which are too many"},
        {"pfm", "PF\n1 2000000000\n-1.0\n", ""},
        {"pfm", "PF\n2000000000 1\n-1.0\n", "found 2000000000 x 1 pixels, which are too many"},
        {"pfm", "PF\n-2 -2\n-1.0\n", "it has no pixels"},
        {"ppm", "P6\n2000000000 2000000000\n255\n", "which are too many"},
        {"hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n",
         "which are too many"}};
    for (const auto& c : cases) {
        const std::string file = path.string() + c.extension;
        std::ofstream(file) << c.contents;
        const uint32_t number = cache.open(file);
        if (*c.sentence) {
            EXPECT_EQ(number, ~0u) << c.contents;
            const std::string said = api().last_error();
            EXPECT_TRUE(said.find(c.sentence) != said.npos ||
                        said.find("corrupt input") != said.npos) // of OpenImageIO 2.5
                << said;
        } else if (number != ~0u) {
            const ovc_texture_area area = point_at(0.5f, 0.5f);
            float rgba[4];
            EXPECT_FALSE(api().sample(cache.handle(), number, &area, rgba)) << c.contents;
        }
        fs::remove(file);
    }
    for (const char* endless : {"/dev/zero", "/tmp"}) {
        EXPECT_EQ(cache.open(endless), ~0u);
        EXPECT_STREQ(api().last_error(), "it is no regular file");
    }
}

TEST(Textures, APictureThatBreaksOffFailsWhereItIsMissing) {
    const TestPicture picture("half.png", 64, 64, 3, OIIO::TypeUInt8, noise(64 * 64 * 3));
    fs::resize_file(picture.path, fs::file_size(picture.path) / 2);
    const Cache cache;
    const uint32_t number = cache.open(picture.path);
    ASSERT_NE(number, ~0u);
    const ovc_texture_area area = point_at(0.5f, 0.01f, OVC_TEXELS_SMOOTH);
    float rgba[4];
    EXPECT_FALSE(api().sample(cache.handle(), number, &area, rgba));
    EXPECT_NE(std::string(api().last_error()), "");
}

TEST(Textures, KeepsToItsMemoryAndAnswersAlikeOnAllThreads) {
    const TestPicture picture("large.tif", 2048, 1024, 3, OIIO::TypeUInt8,
                              noise(size_t(2048) * 1024 * 3));
    const Cache small(uint64_t(10) << 20), large(uint64_t(256) << 20);
    const uint32_t in_small = small.open(picture.path, 0), in_large = large.open(picture.path, 0);
    const auto walk = [&](int first) { // every second tile of the finest level
        for (int i = first; i < 32 * 16; i += 2) {
            const ovc_texture_area area = point_at((float(i % 32) + 0.5f) / 32,
                                                   (float(i / 32) + 0.5f) / 16, OVC_TEXELS_MIPMAPS);
            EXPECT_EQ(small.sample(in_small, area), large.sample(in_large, area));
        }
    };
    std::thread other(walk, 0);
    walk(1);
    other.join();
    EXPECT_LE(api().memory_used(small.handle()), uint64_t(11) << 20);
    EXPECT_GT(api().memory_used(large.handle()), uint64_t(11) << 20);
}

TEST(Textures, ThreadsMayAskForAPictureAtOnce) {
    constexpr int kSize = 256;
    const TestPicture picture("-asked.png", kSize, kSize, 3, OIIO::TypeUInt8,
                              std::vector<float>(3 * kSize * kSize, 1.0f));
    for (int run = 0; run < 30; ++run) {
        const Cache cache;
        const uint32_t number = cache.open(picture.path);
        std::vector<std::thread> threads;
        for (int i = 0; i < 4; ++i)
            threads.emplace_back([&, i] {
                // Each asks for a tile of its own.
                const ovc_texture_area area = point_at(
                    float(i % 2) * 0.5f + 0.2f, float(i / 2) * 0.5f + 0.2f, OVC_TEXELS_MIPMAPS);
                EXPECT_NEAR(cache.sample(number, area)[0], 1, 1e-3);
            });
        for (std::thread& thread : threads)
            thread.join();
    }
}

TEST(Textures, SpeaksOneVersion) {
    void* library = dlopen(OVC_TEXTURES_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    const auto get =
        reinterpret_cast<ovc_get_textures_function>(dlsym(library, "ovc_get_textures"));
    EXPECT_EQ(get(OVC_TEXTURES_VERSION + 1), nullptr);
    EXPECT_EQ(get(OVC_TEXTURES_VERSION)->struct_size, sizeof(ovc_textures_api));
}

} // namespace
