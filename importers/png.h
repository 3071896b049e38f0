// SPDX-License-Identifier: Apache-2.0
// PNG, in and out: pictures of scenes that are read, pictures that are compared, pictures that are
// rendered.
#pragma once

#include "core/result.h"
#include "importers/picture.h"

#include <cstdint>
#include <span>
#include <string>

namespace ovc {

/// Any PNG from the whole file's bytes: samples of 8 bits times 257; of indexed ones also the
/// numbers of colors in their table. Error: a sentence without the file's name.
Result<Picture> read_png(std::span<const uint8_t> file);

/// What is written: rows from the top down of red, green and blue, sRGB codes from 0 to 65535.
struct PngPixels {
    uint32_t width = 0;
    uint32_t height = 0;
    int bits = 8;                      // a sample, 8 or 16; of 8 the codes' upper half is kept
    std::span<const uint16_t> samples; // 3 x width x height
};

/// The bytes of a file, the same for the same pixels. software: what the file says it was made
/// with.
Result<std::string> write_png(const PngPixels& pixels, const std::string& software);

} // namespace ovc
