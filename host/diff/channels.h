// SPDX-License-Identifier: Apache-2.0
// Reads a picture file as named channels, which is how pictures are compared.
#pragma once

#include "core/result.h"
#include "host/output/output.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace ovc {

/// The meaning of the numbers in R, G and B.
enum class Coding { Srgb, Linear };

struct Channels {
    uint32_t width = 0;
    uint32_t height = 0;
    Coding coding = Coding::Linear;
    std::vector<Layer> all; // each width x height
    int64_t x = 0, y = 0;   // of the first pixel, where an .exr is a part of a larger picture

    size_t size() const { return size_t(width) * height; }
    /// Returns the channel of that name; null where there is none.
    const Layer* find(std::string_view name) const;
};

/// Returns the channels of a .png or .exr file. A .png gives R, G, B, and A where it is not 1
/// everywhere: codes divided by the largest, 0 to 1, whatever its depth. An .exr gives all
/// channels, by name. Error: a sentence that names the file.
Result<Channels> read_channels(const std::filesystem::path& path);

/// Converts R, G and B from linear light to the codes of sRGB that a .png file would have, without
/// rounding.
void encode_srgb(Channels& channels);

/// Gives opacity, which is 1 everywhere, to a .png without it beside one that has it.
void add_opacity(Channels& a, Channels& b);

/// Returns the channels of an .exr file of one part, of which these are the bytes, halves as
/// floats. Error: what is wrong, without the file's name.
Result<Channels> read_exr(std::string_view file);

} // namespace ovc
