// SPDX-License-Identifier: Apache-2.0
// Where the files are that a scene names.
#pragma once

#include "core/result.h"
#include "importers/file/files_read.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ovc::pov {

/// The first file of this name in `folders`, then in the folder of POV-Ray's include files; empty:
/// none. `\` counts as `/`; where no file has exactly this name, capital and small letters are the
/// same. extension: ".inc", of a name that has none.
std::filesystem::path find_file(std::string name, std::string_view extension,
                                const std::vector<std::string>& folders,
                                FilesRead* files = nullptr);

/// The whole of a file, unpacked, and empty where it is; lines end with LF.
Result<std::string> read_text(const std::filesystem::path& path, FilesRead* files = nullptr);

} // namespace ovc::pov
