// SPDX-License-Identifier: Apache-2.0
// PNG files are read for the pictures in scenes and for comparisons, and written for rendered
// pictures.
#pragma once

#include "core/result.h"
#include "importers/picture.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace ovc {

/// Reads any PNG from the whole file's bytes. Samples of 8 bits are multiplied by 257; an indexed
/// picture also keeps its indices. The Error is a sentence without the file's name.
Result<Picture> read_png(std::span<const uint8_t> file);

/// The input of write_png(): rows from the top down of red, green and blue, as sRGB codes from 0 to
/// 65535.
struct PngPixels {
    uint32_t width = 0;
    uint32_t height = 0;
    int bits = 8;                      // per sample, 8 or 16; 8 keep the codes' upper half
    std::span<const uint16_t> samples; // 3 x width x height
};

/// Does the same for pictures that are made while they are written, some rows at once.
struct PngRows {
    uint32_t width = 0;
    uint32_t height = 0;
    int bits = 8; // as in PngPixels
    /// Writes the samples of the rows from `first` on: 3 x width x the number of rows.
    std::function<void(uint32_t first, std::span<uint16_t> samples)> read;
};

/// Returns the bytes of a file, the same for the same pixels. The file says that `software` made
/// it.
Result<std::string> write_png(const PngPixels& pixels, const std::string& software);
Result<std::string> write_png(const PngRows& rows, const std::string& software);

} // namespace ovc
