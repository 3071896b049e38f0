// SPDX-License-Identifier: Apache-2.0
// SCENE on the command line: files, or names of generated test scenes.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/log.h"
#include "host/output/output.h"
#include "importers/importer.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace ovc {

/// SCENE and what belongs to it, the same for every subcommand that takes one.
struct SceneArguments {
    std::vector<std::string> scenes; // one at least, all of them one scene
    std::string model;               // empty: not given
    bool strict = false;
    std::string max_triangles; // empty: not given
    std::string tolerance;     // empty: not given
    std::string pov_version;   // empty: not given
    std::string world;         // empty: not given

    /// name: what the help calls the scene.
    void add_to(CLI::App& app, const char* name = "SCENE");
    /// Whether the words make sense, and --model goes with this scene; before anything is read.
    Result<Done> check() const;
    /// As messages and statistics have it: "dragon.ply + floor.obj".
    std::string name() const;
    /// The files it reads.
    std::vector<NamedFile> files() const;
};

/// The name of a test scene makes that scene; everything else is a file (./plants is a file even if
/// plants is not). model: a file whose triangles a test scene shows instead of its own; or empty.
Result<Scene> open_scene(const std::string& source, const ImportOptions& options,
                         const std::string& model = {});
inline Result<Scene> open_scene(const std::string& source, const LogSink& log,
                                const std::string& model = {}) {
    return open_scene(source, ImportOptions{log}, model);
}
/// check() has accepted them. size: of the picture to come, where that is known.
/// files: receives what is read; or null.
Result<Scene> open_scene(const SceneArguments& arguments, const LogSink& log,
                         std::optional<ImageSize> size = {}, FilesRead* files = nullptr);

/// Writes messages up to `most` to standard error, one line each.
LogSink standard_error_log(LogLevel most);

} // namespace ovc
