// SPDX-License-Identifier: Apache-2.0
// The table of sRGB's bytes: the formula's codes, for lights of every size.
#include "host/output/srgb.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(SrgbBytes, AreTheRoundedCodes) {
    const SrgbBytes bytes;
    const auto expect = [&](float light) {
        ASSERT_EQ(int(bytes.of(light)), int(std::lround(srgb_code(light) * 255))) << light;
    };
    constexpr uint32_t kStep = 997; // every so many-th float from 0 to 2
    for (uint32_t bits = 0; bits < std::bit_cast<uint32_t>(2.0f); bits += kStep)
        expect(std::bit_cast<float>(bits));
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float light :
         {-0.0f, -1.0f, 1.0f, 1e30f, kInfinity, -kInfinity, std::nanf(""), 0x1p-13f, 0x1p-149f})
        expect(light);
}

TEST(SrgbBytes, ChangeWhereTheFormulaDoes) {
    const SrgbBytes bytes;
    for (int code = 1; code <= 255; ++code) {
        float light = srgb_light((float(code) - 0.5f) / 255);
        for (int i = 0; i < 64; ++i)
            light = std::nextafter(light, 0.0f);
        for (int i = 0; i < 128; ++i, light = std::nextafter(light, 1.0f))
            ASSERT_EQ(int(bytes.of(light)), int(std::lround(srgb_code(light) * 255))) << light;
    }
}

} // namespace
} // namespace ovc
