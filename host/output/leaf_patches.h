// SPDX-License-Identifier: Apache-2.0
// Leaf patches are a picture in which each leaf of level 1 has a color of its own.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace ovc {

/// Returns the bytes of a PNG file, made from an .exr file with the layers `leaf` and `normal`
/// (`overcast render --aov leaf,normal`). A pixel has the leaf's color, darker where the surface
/// turns away from a light above and to the side, or grey where nothing is hit. Error: a sentence
/// that names the file.
Result<std::string> leaf_patches(const std::filesystem::path& exr);

/// A color with channels from 0 to 1.
struct PatchColor {
    float red, green, blue;
};
/// Returns the color of a leaf. Leaves with neighbouring numbers have colors far apart.
PatchColor patch_color(uint32_t leaf);

} // namespace ovc
