// SPDX-License-Identifier: Apache-2.0
// MTL: the material library of an OBJ file.
#pragma once

#include "core/result.h"
#include "core/scene.h"

#include <filesystem>
#include <vector>

namespace ovc {

/// The materials of the file, in order. Kd becomes the color, clamped to [0, 1]; the mean of Ks the
/// mirror where illum (3 and more, but for 10) asks for reflection. All else, textures too, and
/// what is no number, is passed over.
Result<std::vector<Material>> read_mtl(const std::filesystem::path& path);

} // namespace ovc
