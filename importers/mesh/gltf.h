// SPDX-License-Identifier: Apache-2.0
// A glTF file, plain or binary, is checked and made ready for Assimp.
#pragma once

#include "core/result.h"
#include "importers/file/source.h"

#include <string>
#include <vector>

namespace ovc {

struct GltfFile {
    /// The file without what Overcast does not show: skins, animations, morph targets and further
    /// data of vertices. Assimp 5 reads them as well, and crashes where they are incomplete.
    std::string bytes;
    bool is_binary = false;
    bool has_long_draco = false; // with indices of 32 bits, which Assimp 5.2 loses
    /// A sentence on each kind of thing that the file asks for and does not get.
    std::vector<std::string> left_out;
};

/// Reads the whole file into memory. Error: its JSON is none, it needs an extension that is not
/// known, or its data does not lie where it says. Leaves files of glTF 1 as they are.
Result<GltfFile> read_gltf_file(Source& source);

} // namespace ovc
