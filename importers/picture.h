// SPDX-License-Identifier: Apache-2.0
// Picture holds the pixels of a picture file, before anyone says what light they stand for.
#pragma once

#include "core/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

/// Rows run from the top down, pixels from left to right; a sample goes from 0 to 65535.
struct Picture {
    uint32_t width = 0;
    uint32_t height = 0;
    bool gray = false;
    std::vector<std::array<uint16_t, 4>> pixels; // red, green, blue, opacity
    std::vector<uint8_t> indices; // into the file's table of colors; empty without a table

    size_t size() const { return size_t(width) * height; }
};

/// make_picture() refuses more pixels than this.
inline constexpr uint64_t kMaxPixels = uint64_t(1) << 26;

/// Returns a picture of that size without pixels; an Error if it would be empty or too large.
Result<Picture> make_picture(uint64_t width, uint64_t height);

} // namespace ovc
