// SPDX-License-Identifier: Apache-2.0
// Reads the pictures that scenes name for height fields and image_maps. The first bytes of a file
// tell its format; TGA has no such bytes, so there the name does.
#pragma once

#include "importers/picture.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace ovc::pov {

/// Reads a picture of any of these formats. The Error is a sentence that names the file.
Result<Picture> read_picture(const std::filesystem::path& path);

/// Returns the height, from 0 to 1, that POV-Ray's height_field gives to a pixel: its index into
/// the table of colors, its gray, or 256 x red + green.
double height_of(const Picture& picture, size_t pixel);

/// These read the formats besides PNG from the whole file's bytes. read_pnm needs at least 2 bytes,
/// of which it relies on the second. The Error is a sentence without the file's name.
using Bytes = std::span<const uint8_t>;
Result<Picture> read_jpeg(Bytes file);
Result<Picture> read_gif(Bytes file);
Result<Picture> read_pnm(Bytes file);
Result<Picture> read_tga(Bytes file);

} // namespace ovc::pov
