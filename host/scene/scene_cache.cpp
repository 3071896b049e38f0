// SPDX-License-Identifier: Apache-2.0
// The cache has a file for each scene and set of options, named by a checksum of the request. The
// file itself tells whether it is stale.
#include "host/scene/scene_cache.h"

#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

namespace ovc {

namespace fs = std::filesystem;

std::string request_of(const SceneArguments& arguments, const BackendOptions& backend,
                       std::optional<ImageSize> size) {
    std::error_code ec;
    std::vector<std::string> scenes;
    for (const std::string& scene : arguments.scenes)
        scenes.push_back(
            is_test_scene(scene) ? scene : fs::absolute(scene, ec).lexically_normal().string());
    // POV-Ray's scenes may ask for the picture's size.
    const bool sized = size && arguments.name().find(".pov") != std::string::npos;
    return fmt::format(
        "scene {} world {} model {} strict {} most {} tolerance {} version {} size {}x{} leaf "
        "{} leaves {} memory {} {}",
        fmt::join(scenes, "\n"), arguments.world,
        arguments.model.empty() ? "" : fs::absolute(arguments.model, ec).string(), arguments.strict,
        arguments.max_triangles, arguments.tolerance, arguments.pov_version,
        sized ? size->width : 0, sized ? size->height : 0, backend.leaf_triangles, backend.leaves,
        backend.gpu_memory.bytes, backend.gpu_memory.share);
}

/// Returns the scene's name and a checksum, such as "plants-0123456789abcdef.ovc".
static std::string file_name(const std::string& scene, const std::string& request) {
    std::string stem = fs::path(scene).filename().string();
    stem = stem.substr(0, stem.find('.'));
    return fmt::format("{}-{:016x}.ovc", stem,
                       checksum_of(bytes_of(std::span<const char>(request))));
}

SceneCache::SceneCache(const std::string& folder, const SceneArguments& arguments,
                       const BackendOptions& backend, std::optional<ImageSize> size)
    : arguments_(arguments), size_(size) {
    assert(!arguments.scenes.empty());
    const std::string& first = arguments.scenes[0];
    const bool is_cache = arguments.scenes.size() == 1 && fs::path(first).extension() == ".ovc";
    if (folder.empty() || is_cache) // an .ovc file is a cache itself
        return;
    if (arguments.moment.in_sequence && arguments.may_move())
        return; // it is another scene in each frame
    from_.request = request_of(arguments, backend, size);
    path_ = fs::path(folder) / file_name(first, from_.request);
}

Result<Scene> SceneCache::open(const LogSink& log) {
    if (path_.empty())
        return open_scene(arguments_, log, size_);
    std::error_code ec;
    if (fs::exists(path_, ec)) {
        Result<SceneFile> file = read_scene_file(path_);
        const FileStamp* changed = file ? file->from.changed_file() : nullptr;
        if (!file)
            say(log, LogLevel::Warning,
                fmt::format("reading the scene anew: {}", file.error().message));
        else if (changed)
            say(log, LogLevel::Info,
                fmt::format("reading the scene anew: {} has changed", changed->path));
        else if (file->from.request == from_.request) {
            for (const std::string& warning : file->from.warnings)
                say(log, LogLevel::Warning, warning);
            found_ = true;
            from_ = std::move(file->from);
            return std::move(file->scene);
        }
    }
    FilesRead files;
    // Another build of this program may make another scene of the same files.
    files.note(fs::read_symlink("/proc/self/exe", ec));
    const LogSink listening = [&](LogLevel level, const std::string& message) {
        if (level == LogLevel::Warning)
            from_.warnings.push_back(message);
        say(log, level, message);
    };
    Result<Scene> scene = open_scene(arguments_, listening, size_, &files);
    from_.files = files.stamps();
    return scene;
}

SaveLevels levels_of(const Backend& backend) {
    return [&backend](const ByteSink& sink) { return backend.save(sink); };
}

void SceneCache::keep(const Scene& scene, const Backend& backend, const LogSink& log) {
    if (path_.empty() || (found_ && (!backend.saves() || backend.statistics().from_saved)))
        return;
    std::error_code ec;
    fs::create_directories(path_.parent_path(), ec);
    const Result<Done> written =
        write_scene_file(scene, from_, backend.saves() ? levels_of(backend) : SaveLevels(), path_);
    if (!written)
        say(log, LogLevel::Warning,
            fmt::format("nothing was kept for the next time: {}", written.error().message));
}

} // namespace ovc
