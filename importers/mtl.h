// SPDX-License-Identifier: Apache-2.0
// MTL: the material library of an OBJ file.
#pragma once

#include "core/log.h"
#include "core/result.h"
#include "core/scene.h"
#include "importers/files_read.h"

#include <filesystem>
#include <vector>

namespace ovc {

/// The materials of the file, in order. Kd becomes the color, clamped to [0, 1]; the mean of Ks the
/// mirror where illum (3 to 8) asks for reflection. Where it asks for glass (4, 6, 7, 9), what is
/// not mirrored goes through: 1 - d of it, else Tr, or all where neither dims it; Tf becomes the
/// filter, and Ni the index of refraction where illum is 6 or 7. Fresnel's equations (5, 7) are
/// left out. All else, and what is no number, is passed over; of textures and of the light that
/// surfaces send out (Ke) the log gets a warning, each once for the file.
Result<std::vector<Material>> read_mtl(const std::filesystem::path& path, const LogSink& log,
                                       FilesRead* files = nullptr);

} // namespace ovc
