// SPDX-License-Identifier: Apache-2.0
// Finds and reads the files that a scene names.
#pragma once

#include "core/result.h"
#include "importers/file/files_read.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ovc::pov {

/// Returns the first file of this name in `folders` and then in the folders of POV-Ray's include
/// files, or an empty path. `\` counts as `/`. Where no file has exactly this name, upper and lower
/// case are the same. `extension`, such as ".inc", is tried for a name that has none. `files`, or
/// null, receives the paths that are tried.
std::filesystem::path find_file(std::string name, std::string_view extension,
                                const std::vector<std::string>& folders,
                                FilesRead* files = nullptr);

/// Returns a file's text, decompressed, with lines that end with LF. An empty file is no error.
Result<std::string> read_text(const std::filesystem::path& path, FilesRead* files = nullptr);

} // namespace ovc::pov
