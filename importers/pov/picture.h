// SPDX-License-Identifier: Apache-2.0
// Pictures that scenes name: for height fields, and for the average color of an image_map. The kind
// is told by the file's first bytes; TGA, which has none, by its name.
#pragma once

#include "core/result.h"
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ovc::pov {

/// Rows from the top down, pixels from left to right; a sample goes from 0 to 65535.
struct Picture {
    uint32_t width = 0;
    uint32_t height = 0;
    bool gray = false;
    std::vector<std::array<uint16_t, 4>> pixels; // red, green, blue, opacity
    std::vector<uint8_t> indices; // into the file's table of colors; empty: it has none

    size_t size() const { return size_t(width) * height; }
};

/// Error: a sentence that names the file.
Result<Picture> read_picture(const std::filesystem::path& path);

/// What POV-Ray's height_field takes for a pixel's height, 0 to 1: its number in the table of
/// colors, its gray, or 256 x red + green.
double height_of(const Picture& picture, size_t pixel);

/// More pixels than this are refused.
inline constexpr uint64_t kMostPixels = uint64_t(1) << 26;

/// The formats, each from the whole file's bytes. Error: a sentence without the file's name.
using Bytes = std::span<const uint8_t>;
Result<Picture> read_png(Bytes file);
Result<Picture> read_jpeg(Bytes file);
Result<Picture> read_gif(Bytes file);
Result<Picture> read_pnm(Bytes file);
Result<Picture> read_tga(Bytes file);

/// Of that size, or an Error for one that is empty or too large.
Result<Picture> make_picture(uint64_t width, uint64_t height);

} // namespace ovc::pov
