// SPDX-License-Identifier: Apache-2.0
// MTL: the material library of an OBJ file.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "importers/file/files_read.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ovc {

/// A material, and what its library asks for besides and does not get.
struct LibraryMaterial {
    Material material;
    std::vector<std::string> textures; // "map_Kd 'wood.png'", each once
    bool emits = false;                // Ke
};

/// The materials of the file, in order. Kd becomes the color, clamped to [0, 1]; the mean of Ks the
/// mirror where illum (3 to 8) asks for reflection. Where it asks for glass (4, 6, 7, 9), what is
/// not mirrored goes through: 1 - d of it, else Tr, or all where neither dims it; Tf becomes the
/// filter, and Ni the index of refraction where illum is 6 or 7. Fresnel's equations (5, 7) are
/// left out. All else, and what is no number, is passed over.
Result<std::vector<LibraryMaterial>> read_mtl(const std::filesystem::path& path,
                                              FilesRead* files = nullptr);

} // namespace ovc
