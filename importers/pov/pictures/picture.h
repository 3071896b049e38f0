// SPDX-License-Identifier: Apache-2.0
// Pictures that scenes name: for height fields, and for the average color of an image_map. The kind
// is told by the file's first bytes; TGA, which has none, by its name.
#pragma once

#include "importers/picture.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace ovc::pov {

/// Error: a sentence that names the file.
Result<Picture> read_picture(const std::filesystem::path& path);

/// What POV-Ray's height_field takes for a pixel's height, 0 to 1: its number in the table of
/// colors, its gray, or 256 x red + green.
double height_of(const Picture& picture, size_t pixel);

/// The formats besides PNG, each from the whole file's bytes. Error: a sentence without the file's
/// name.
using Bytes = std::span<const uint8_t>;
Result<Picture> read_jpeg(Bytes file);
Result<Picture> read_gif(Bytes file);
Result<Picture> read_pnm(Bytes file);
Result<Picture> read_tga(Bytes file);

} // namespace ovc::pov
