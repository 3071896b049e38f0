// SPDX-License-Identifier: Apache-2.0
// A picture file as named channels, which is how pictures are compared.
#pragma once

#include "core/result.h"
#include "host/output/output.h"

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace ovc {

/// What the numbers of R, G and B are.
enum class Coding { Srgb, Linear };

struct Channels {
    uint32_t width = 0;
    uint32_t height = 0;
    Coding coding = Coding::Linear;
    std::vector<Layer> all; // each width x height

    size_t size() const { return size_t(width) * height; }
    /// Null: there is none of that name.
    const Layer* find(std::string_view name) const;
};

/// Of a .png file R, G, B, and A where it is not 1 everywhere: codes divided by the largest, 0 to
/// 1, whatever its depth. Of an .exr file all channels, by name. Error: a sentence that names the
/// file.
Result<Channels> read_channels(const std::filesystem::path& path);

/// R, G and B as the codes of sRGB that a .png file would have, but not rounded.
void encode_srgb(Channels& channels);

/// The first part of an .exr file. Error: what is wrong, without the file's name.
Result<Channels> read_exr(const std::filesystem::path& path);

} // namespace ovc
