// SPDX-License-Identifier: Apache-2.0
// Image: layout and the metric.
#include "core/file/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ovc {
namespace {

TEST(Image, StartsBlackAndTransparent) {
    const Image image(3, 2);
    ASSERT_EQ(image.pixels.size(), 6u);
    for (const vec4& pixel : image.pixels)
        EXPECT_EQ(pixel, vec4(0));
}

TEST(Image, RowsFollowEachOther) {
    Image image(3, 2);
    image.at(2, 0) = vec4(1);
    image.at(0, 1) = vec4(2);
    EXPECT_EQ(image.pixels[2], vec4(1));
    EXPECT_EQ(image.pixels[3], vec4(2));
}

TEST(ImageDifference, OfAnImageWithItselfIsNothing) {
    Image image(4, 4);
    for (size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = vec4(float(i) * 0.1f, -1e30f, 1e-40f, 1);
    const ImageDifference d = difference(image, image);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.differing, 0u);
}

TEST(ImageDifference, OfNoPixelsIsNothing) {
    const ImageDifference d = difference(Image(), Image());
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.differing, 0u);
}

TEST(ImageDifference, SeesEveryChannelAndCountsAPixelOnce) {
    for (int channel = 0; channel < 4; ++channel) {
        const Image a(2, 2);
        Image b(2, 2);
        b.at(1, 1)[channel] = -0.5f;
        const ImageDifference d = difference(a, b);
        EXPECT_EQ(d.max, 0.5) << channel;
        EXPECT_EQ(d.rmse, std::sqrt(0.25 / 16)) << channel;
        EXPECT_EQ(d.differing, 1u) << channel;
    }
}

TEST(ImageDifference, SeesOneUlp) {
    Image a(1, 1), b(1, 1);
    a.at(0, 0) = vec4(1);
    b.at(0, 0) = vec4(1);
    b.at(0, 0).y = std::nextafter(1.0f, 2.0f);
    const ImageDifference d = difference(a, b);
    EXPECT_EQ(d.differing, 1u);
    EXPECT_EQ(d.max, 0x1p-23);
}

TEST(ImageDifference, IsSymmetric) {
    Image a(2, 1), b(2, 1);
    a.at(0, 0) = vec4(1, 2, 3, 4);
    b.at(1, 0) = vec4(4, 3, 2, 1);
    const ImageDifference ab = difference(a, b);
    const ImageDifference ba = difference(b, a);
    EXPECT_EQ(ab.max, ba.max);
    EXPECT_EQ(ab.rmse, ba.rmse);
    EXPECT_EQ(ab.differing, 2u);
    EXPECT_EQ(ba.differing, 2u);
}

} // namespace
} // namespace ovc
