// SPDX-License-Identifier: Apache-2.0
// An MTL file is the material library of an OBJ file.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "importers/file/source.h"
#include "importers/mesh/obj/mtl_textures.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ovc {

/// A material, and the parts of it that we leave out.
struct LibraryMaterial {
    Material material;
    std::vector<MtlTexture> shown = {};     // for add_mtl_texture()
    std::vector<std::string> textures = {}; // others, "refl 'sky.png'", each once
    vec3 emission{0};                       // Ke
    std::filesystem::path library = {};
    uint64_t missing_at = 0; // the line that uses it, where no library has it; else 0
};

/// Returns the materials of the file, in order. Kd becomes the color, clamped to [0, 1]; the mean
/// of Ks becomes the mirror if illum (3 to 8) asks for reflection. Of the light that is not
/// mirrored, 1 - d passes through, else Tr; if illum asks for glass (4, 6, 7, 9), all of it if
/// neither dims it, Tf becomes the filter, and Ni the index of refraction if illum is 6 or 7.
/// Fresnel's equations (5, 7) are left out. Ke and the textures of mtl_textures.h are kept for the
/// reader. Statements that the format knows and that mean nothing here are ignored; others are
/// said, once per kind. Error: a color or number that is none. path: of the source; log: receives
/// the warnings.
Result<std::vector<LibraryMaterial>> read_mtl(Source& source, const std::filesystem::path& path,
                                              const LogSink& log);

} // namespace ovc
