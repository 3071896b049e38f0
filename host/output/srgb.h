// SPDX-License-Identifier: Apache-2.0
// sRGB's curve between linear light and the codes of picture files.
// Source: IEC 61966-2-1.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace ovc {

/// Returns the code of linear light, both 0 to 1. Light beyond that counts as the nearest end, and
/// NaN as 0.
inline float srgb_code(float linear) {
    const float clamped = linear > 0 ? std::min(linear, 1.0f) : 0.0f;
    return clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
}

/// Rounds srgb_code() to 8 bits, from 0 to 255, without its power: pictures ask a million times.
class SrgbBytes {
public:
    SrgbBytes() {
        for (int code = 1; code <= 255; ++code)
            from_[size_t(code)] = first_light_of(code);
        from_[256] = std::numeric_limits<float>::infinity();
        uint8_t code = 0;
        for (uint32_t cell = 0; cell < kCells; ++cell) {
            const float light = std::bit_cast<float>(kFirst + (cell << kCellBits));
            while (from_[code + 1u] <= light)
                ++code;
            code_at_[cell] = code;
        }
    }

    uint8_t of(float light) const {
        if (!(light >= from_[1])) // NaN, too
            return 0;
        if (light >= from_[255])
            return 255;
        uint8_t code = code_at_[(std::bit_cast<uint32_t>(light) - kFirst) >> kCellBits];
        while (light >= from_[code + 1u]) // twice at most
            ++code;
        return code;
    }

private:
    // Light below kFirst has the code 0. Cells are as wide as 1/64 of what they begin at.
    static constexpr uint32_t kFirst = std::bit_cast<uint32_t>(0x1p-13f);
    static constexpr uint32_t kCellBits = 17;
    static constexpr uint32_t kCells = (std::bit_cast<uint32_t>(1.0f) - kFirst) >> kCellBits;

    static long rounded(float light) { return std::lround(srgb_code(light) * 255); }

    static float first_light_of(int code) {
        // Between these two lies the first float that is rounded to the code.
        float below = 0, at = 1;
        for (;;) {
            const float middle = std::bit_cast<float>(
                (std::bit_cast<uint32_t>(below) + std::bit_cast<uint32_t>(at)) / 2);
            if (middle == below)
                return at;
            (rounded(middle) >= code ? at : below) = middle;
        }
    }

    std::array<float, 257> from_{}; // the least light of each code
    std::array<uint8_t, kCells> code_at_{};
};

/// Returns srgb_code() rounded to 8 bits.
inline uint8_t srgb_byte(float light) {
    static const SrgbBytes kBytes;
    return kBytes.of(light);
}

/// Returns the linear light of a code from 0 to 1.
inline float srgb_light(float code) {
    return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

} // namespace ovc
