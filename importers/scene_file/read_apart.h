// SPDX-License-Identifier: Apache-2.0
// A reader that others wrote reads in a process of its own, where its faults end nobody else.
#pragma once

#include "importers/importer.h"

#include <filesystem>
#include <string_view>

namespace ovc {

using SceneReader = Result<Scene> (*)(const std::filesystem::path& path,
                                      const ImportOptions& options);

/// Returns read(path, options), which a child process has called. The scene lies in a file in
/// memory (Scene::files). options.log and options.files get what the reader told them, unless it
/// fails; the rest of the options may not be pointers that it writes to. Error: besides, the child
/// crashed, which the sentence says of `name`, or took more time or memory than the files that it
/// read can need, or more memory than is free. Where the system starts no process, this one calls
/// the reader.
Result<Scene> read_apart(SceneReader read, std::string_view name, const std::filesystem::path& path,
                         const ImportOptions& options);

} // namespace ovc
