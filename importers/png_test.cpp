// SPDX-License-Identifier: Apache-2.0
// A written PNG is read back to the last bit, and follows the format's specification.
#include "importers/png.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

std::vector<uint16_t> ramp(uint32_t width, uint32_t height) {
    std::vector<uint16_t> samples(size_t(3) * width * height);
    for (size_t i = 0; i < samples.size(); ++i)
        samples[i] = uint16_t(i * 7 % 256 * 257); // 8 bits hold them exactly
    return samples;
}

std::span<const uint8_t> png_bytes(const std::string& text) {
    return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

TEST(Png, IsReadBackAsItWasWritten) {
    const std::vector<uint16_t> even = ramp(13, 7);
    std::vector<uint16_t> odd = even;
    for (uint16_t& sample : odd)
        sample ^= 0x35; // what only 16 bits hold
    for (const int bits : {8, 16}) {
        const std::vector<uint16_t>& samples = bits == 8 ? even : odd;
        const Result<std::string> file = write_png({13, 7, bits, samples}, "a test");
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ((*file)[24], bits); // IHDR's sample depth
        EXPECT_EQ((*file)[25], 2);    // red, green and blue
        EXPECT_NE(file->find("sRGB"), std::string::npos);
        EXPECT_NE(file->find(std::string("tEXtSoftware\0a test", 19)), std::string::npos);
        EXPECT_EQ(*file, *write_png({13, 7, bits, samples}, "a test"));
        const Result<Picture> picture = read_png(png_bytes(*file));
        ASSERT_TRUE(picture) << picture.error().message;
        ASSERT_EQ(picture->size(), 13u * 7);
        for (size_t i = 0; i < samples.size(); ++i)
            ASSERT_EQ(picture->pixels[i / 3][i % 3], samples[i]) << bits << ", " << i;
        EXPECT_EQ(picture->pixels[5][3], 65535);
    }
}

TEST(Png, ACutFileIsRefused) {
    const std::string whole = *write_png({13, 7, 16, ramp(13, 7)}, "a test");
    for (size_t length = 0; length + 12 < whole.size(); ++length) // the end has no pixels
        EXPECT_FALSE(read_png(png_bytes(whole.substr(0, length)))) << length;
}

} // namespace
} // namespace ovc
