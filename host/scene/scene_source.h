// SPDX-License-Identifier: Apache-2.0
// SCENE on the command line is a file, or the name of a generated test scene.
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

/// SCENE and its options, the same for every subcommand that takes one.
struct SceneArguments {
    std::vector<std::string> scenes; // at least one; all are joined to one scene
    std::string model;               // empty: not given
    bool strict = false;
    std::string max_triangles; // empty: not given
    std::string tolerance;     // empty: not given
    std::string pov_version;   // empty: not given
    std::string world;         // empty: not given
    Moment moment;             // that the scene is to be of
    uint64_t host_bytes = 0;   // its triangles need not fit into them; 0: no limit

    /// name: the scene's name in the help.
    void add_to(CLI::App& app, const char* name = "SCENE");
    /// Checks the values, and that --model goes with this scene, before anything is read.
    Result<Done> check() const;
    /// Returns the scene's name in messages and statistics: "dragon.ply + floor.obj".
    std::string name() const;
    /// Returns whether it is one scene file, whose triangles need not fit into memory.
    bool is_one_scene_file() const;
    /// Returns whether what it names may move with the moment.
    bool may_move() const;
    /// Returns the files that the user named; test scenes are none.
    std::vector<NamedFile> files() const;
};

/// Makes the test scene of that name, or reads the file (./plants is a file even if plants is not).
/// model: a file or a test scene whose triangles a test scene shows instead of its own; or empty.
Result<Scene> open_scene(const std::string& source, const ImportOptions& options,
                         const std::string& model = {});
inline Result<Scene> open_scene(const std::string& source, const LogSink& log,
                                const std::string& model = {}) {
    return open_scene(source, ImportOptions{log}, model);
}
/// Returns how the arguments, which check() must have accepted, want files read. files: receives
/// those; or null.
ImportOptions import_options(const SceneArguments& arguments, const LogSink& log, FilesRead* files);
/// Opens all scenes of the arguments, which check() must have accepted, as one. size: of the
/// picture to come, where that is known. files: receives the files that are read; or null.
Result<Scene> open_scene(const SceneArguments& arguments, const LogSink& log,
                         std::optional<ImageSize> size = {}, FilesRead* files = nullptr);

/// Returns a log that writes messages up to the level `max_level` to standard error, one line each.
LogSink standard_error_log(LogLevel max_level);

} // namespace ovc
