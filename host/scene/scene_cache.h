// SPDX-License-Identifier: Apache-2.0
// --cache DIR: scenes and what was built of them, kept from one run to the next.
#pragma once

#include "host/backend/backend.h"
#include "host/scene/scene_source.h"
#include "importers/scene_file.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ovc {

/// One scene as one set of options asks for it.
class SceneCache {
public:
    /// folder: empty: nothing is kept. size: as for open_scene().
    SceneCache(const std::string& folder, const SceneArguments& arguments,
               const BackendOptions& backend, std::optional<ImageSize> size);

    /// The scene, from the cache where that has it as its files are now, else from them. Warnings
    /// come either way.
    Result<Scene> open(const LogSink& log);

    /// Whether open() found it there.
    bool found() const { return found_; }

    /// Keeps the scene that open() gave, and what the backend has built of it, unless all of that
    /// came from there. Where that fails the log gets a warning.
    void keep(const Scene& scene, const Backend& backend, const LogSink& log);

    /// The file; empty: none.
    const std::filesystem::path& path() const { return path_; }

private:
    const SceneArguments& arguments_;
    const std::optional<ImageSize> size_;
    std::filesystem::path path_;
    Provenance from_;
    bool found_ = false;
};

/// For write_scene_file(): what the backend saves; where it cannot, the log gets a warning and the
/// file no levels.
SaveLevels levels_of(const Backend& backend);

} // namespace ovc
