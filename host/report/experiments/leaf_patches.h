// SPDX-License-Identifier: Apache-2.0
// Leaf patches: a picture in which each leaf of level 1 has a colour of its own.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <filesystem>
#include <string>

namespace ovc {

/// The bytes of a PNG file, from an .exr file with the layers `leaf` and `normal` (`overcast render
/// --aov leaf,normal`): the leaf's colour, darker where the surface turns away from above and from
/// the side; grey where nothing is hit. Error: a sentence that names the file.
Result<std::string> leaf_patches(const std::filesystem::path& exr);

/// Neighbouring numbers have colours far apart. red, green, blue from 0 to 1.
struct PatchColor {
    float red, green, blue;
};
PatchColor patch_color(uint32_t leaf);

} // namespace ovc
