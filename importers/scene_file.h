// SPDX-License-Identifier: Apache-2.0
// The scene file, .ovc: everything of core/scene.h, and what the plugin has built of it, mapped
// into memory when it is read. It is a cache: for this version on this kind of machine.
#pragma once

#include "core/file/archive.h"
#include "importers/file/files_read.h"
#include "importers/importer.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ovc {

/// What a scene was made from.
struct Provenance {
    std::string request;          // what was asked for, in any words
    std::vector<FileStamp> files; // that were read or missed
    std::vector<std::string> warnings;

    /// The first file that is not as it was; null where all are.
    const FileStamp* changed_file() const;
};

struct SceneFile {
    Scene scene; // its chunks and Scene::saved lie in Scene::files
    Provenance from;
};

/// Writes what is saved of the scene's levels, for Scene::saved.
using SaveLevels = std::function<Result<Done>(const ByteSink&)>;

/// save_levels: may be empty. The file is replaced only once the new one is complete.
Result<Done> write_scene_file(const Scene& scene, const Provenance& from,
                              const SaveLevels& save_levels, const std::filesystem::path& path);

/// Of all that a picture of the scene depends on, and names.
uint64_t checksum_of(const Scene& scene);

/// Error: damage, another version, no such file; the sentence begins with the path. Everything but
/// the levels, which the plugin checks, is checked: what comes back is a sound scene.
Result<SceneFile> read_scene_file(const std::filesystem::path& path);

} // namespace ovc
