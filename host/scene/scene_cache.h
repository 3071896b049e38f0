// SPDX-License-Identifier: Apache-2.0
// --cache DIR keeps scenes, and the structures that were built of them, from one run to the next.
#pragma once

#include "host/backend/backend.h"
#include "host/scene/scene_source.h"
#include "importers/scene_file/scene_file.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ovc {

/// The cache's entry for one scene with one set of options.
class SceneCache {
public:
    /// folder: where it is empty, nothing is kept; nor of a scene that may move in a sequence.
    /// arguments: name at least one scene, and must
    /// outlive it. size: as for open_scene().
    SceneCache(const std::string& folder, const SceneArguments& arguments,
               const BackendOptions& backend, std::optional<ImageSize> size);

    /// Returns the scene: from the cache where the entry fits the files as they are now, else from
    /// the files. The log gets the scene's warnings either way.
    Result<Scene> open(const LogSink& log);

    /// Returns whether open() found the scene in the cache.
    bool found() const { return found_; }

    /// Keeps the scene that open() gave, and the levels that the backend has built of it, unless
    /// all of that came from the cache. A failure is a warning in the log.
    void keep(const Scene& scene, const Backend& backend, const LogSink& log);

    /// Returns the entry's file; empty where nothing is kept.
    const std::filesystem::path& path() const { return path_; }

private:
    const SceneArguments& arguments_;
    const std::optional<ImageSize> size_;
    std::filesystem::path path_;
    Provenance from_;
    bool found_ = false;
};

/// Returns everything besides the files that a scene and its levels depend on.
std::string request_of(const SceneArguments& arguments, const BackendOptions& backend,
                       std::optional<ImageSize> size);

/// Returns a function for write_scene_file() that writes the levels of the backend, which must
/// outlive it. backend: saves() is true.
SaveLevels levels_of(const Backend& backend);

} // namespace ovc
