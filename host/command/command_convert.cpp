// SPDX-License-Identifier: Apache-2.0
// overcast convert: any input to .ply, .obj or .ovc.
#include "host/arguments/arguments.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/log_arguments.h"
#include "host/backend/device_opening.h"
#include "host/backend/streamed_levels.h"
#include "host/command/command.h"
#include "host/output/output.h"
#include "host/scene/kept_conversion.h"
#include "host/scene/scene_cache.h"
#include "host/scene/scene_in_store.h"
#include "host/scene/scene_source.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"
#include "importers/importer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace ovc {

static constexpr const char* kConvertExamples = R"(Examples:
  overcast convert kitchen.obj kitchen.ply
  overcast convert dragon.ply.gz dragon.ply
  overcast convert plants plants.ply          a generated scene, for other programs
  overcast convert plants.pbrt plants.ovc     with materials, lights, camera and what tracing builds:
  overcast render plants.ovc                  starts at once
  overcast convert scan.ply scan.ovc --host-memory 2G    of a scene larger than memory)";

static std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

/// Checks the output's name before a big scene is read for nothing.
static Result<Done> check_output(const std::filesystem::path& path) {
    const std::string extension = extension_of(path);
    if (extension != ".ply" && extension != ".obj" && extension != ".ovc")
        return Error{
            fmt::format("the output file '{}' ends in none of .ply, .obj, .ovc", path.string())};
    return check_writable("output", path);
}

/// Returns, as a text for the user, what a mesh file does not keep of the scene; empty where it
/// keeps all.
static std::string left_out(const Scene& scene) {
    std::vector<std::string> items;
    const auto add = [&](size_t count, std::string_view what) {
        if (count > 0)
            items.push_back(fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"));
    };
    // The default grey does not count: every scene has it.
    add(size_t(std::count_if(scene.materials.begin(), scene.materials.end(),
                             [](const Material& material) {
                                 return material.color != Material{}.color ||
                                        material.mirror != 0 || material.transmission != 0;
                             })),
        "material");
    add(scene.lights.size(), "light");
    if (scene.camera)
        items.push_back("the camera");
    if (std::any_of(scene.meshes.begin(), scene.meshes.end(),
                    [](const MeshInfo& mesh) { return !mesh.normals.empty(); }))
        items.push_back("the vertex normals");
    return fmt::format("{}", fmt::join(items, ", "));
}

/// Returns a log that enters warnings in `from` as well, which outlives it, as `log` does.
static LogSink noting_warnings(Provenance& from, const LogSink& log) {
    return [&](LogLevel level, const std::string& message) {
        if (level == LogLevel::Warning)
            from.warnings.push_back(message);
        say(log, level, message);
    };
}

/// Builds a scene that memory holds, and writes all of it as .ovc.
static Result<Done> save_held(const Scene& scene, const Provenance& from, BackendOptions options,
                              const LogSink& log, const std::string& output) {
    options.saved = scene.saved;
    const Result<std::unique_ptr<Backend>> backend = make_backend(scene.soup, options, log);
    if (!backend)
        return backend.error();
    if (!(*backend)->saves())
        say(log, LogLevel::Warning,
            fmt::format("{} holds the scene alone: only two-level can be saved", output));
    return write_scene_file(scene, from, (*backend)->saves() ? levels_of(**backend) : SaveLevels(),
                            output);
}

/// Writes all of the scene, and what the plugin builds of it, as .ovc.
static Result<Done> convert_to_scene_file(const SceneArguments& source,
                                          const BackendOptions& options, const LogSink& log,
                                          const std::string& output) {
    FilesRead files;
    Provenance from;
    const LogSink listening = noting_warnings(from, log);
    const Result<Scene> scene = open_scene(source, listening, std::nullopt, &files);
    if (!scene)
        return scene.error();
    from.files = files.stamps();
    return save_held(*scene, from, options, log, output);
}

/// Builds the triangles in the store, and writes all of the scene as .ovc.
static Result<Done> save_stored(const Scene& scene, const TriangleStore& store,
                                const Provenance& from, BackendOptions options, const LogSink& log,
                                const std::filesystem::path& output) {
    Result<ScratchFile> scratch = ScratchFile::create(output.parent_path());
    if (!scratch)
        return scratch.error();
    options.watching = BuildWatching::Shown;
    const SaveLevels save_levels = [&](const ByteSink& sink) {
        return save_streamed_levels(triangles_in(scene, store), options.host_bytes, *scratch,
                                    options, log, sink);
    };
    return write_scene_file(scene, store, from, save_levels, output);
}

/// As convert_to_scene_file(), within so much host memory. kept: null keeps nothing; else its front
/// is written, unless memory holds the scene.
static Result<Done> convert_streamed(const SceneArguments& source, const BackendOptions& options,
                                     const LogSink& log, const std::string& output,
                                     KeptConversion* kept = nullptr) {
    Provenance from;
    FilesRead files;
    const Result<SceneInStore> read =
        stream_scene(source, options.host_bytes, std::filesystem::path(output).parent_path(),
                     noting_warnings(from, log), &files);
    if (!read)
        return read.error();
    from.files = files.stamps();
    if (read->is_held()) {
        if (kept)
            kept->remove();
        return save_held(read->scene, from, options, log, output);
    }
    return kept ? kept->write_front(read->scene, read->store, from)
                : save_stored(read->scene, read->store, from, options, log, output);
}

/// Does the same as convert_streamed(), from where an earlier run ended.
static Result<Done> continue_streamed(const SceneArguments& source, const BackendOptions& options,
                                      const LogSink& log, const std::string& output) {
    Result<KeptConversion> kept = KeptConversion::open(output, source, options);
    if (!kept)
        return kept.error();
    const Result<Done> found = kept->take_front();
    Result<Done> done = Done{};
    if (!found) {
        say(log, LogLevel::Info,
            fmt::format("--continue: {}; the conversion is begun", found.error().message));
        done = convert_streamed(source, options, log, output, &*kept);
        if (done && !kept->has_front())
            return done; // memory holds the scene
    }
    if (done)
        done = kept->finish(options, log);
    if (!done)
        say(log, LogLevel::Info,
            fmt::format("the same command goes on from {}, as far as that is sound",
                        kept->unfinished().string()));
    return done;
}

static Result<Done> convert_to_mesh(const SceneArguments& source, const LogSink& log,
                                    const std::string& output, bool quiet) {
    const Result<Scene> scene = open_scene(source, log);
    if (!scene)
        return scene.error();
    if (Result<Done> saved = save(*scene, output); !saved)
        return saved;
    if (const std::string items = left_out(*scene); !items.empty() && !quiet)
        print_message(fmt::format("only triangles are kept; left out of {}: {}", output, items));
    return Done{};
}

namespace {

class Convert final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description(
            "Writes the triangles of a scene as .ply (binary) or .obj, or all of it "
            "and what tracing builds as .ovc, which starts at once (docs/guide/cache.md).");
        source_.add_to(app, "IN");
        // CLI11 gives all names to IN; run() takes the last of them as OUT.
        app.add_option("OUT", output_,
                       "The file to write, the last that is named; replaced only once the new one "
                       "is complete");
        log_.add_to(app, /* with_quiet= */ true);
        backend_.add_to(
            app, "For .ovc of .ply, .obj, .pbrt and landscape-N: the most host memory to use, 2G, "
                 "besides what the program and the driver take; the triangles wait on the disk of "
                 "OUT");
        app.add_flag("--continue", go_on_,
                     "With --host-memory: keep what is done beside OUT, in OUT.unfinished.ovc and "
                     "two more files, until all of it is; and go on from what an earlier run with "
                     "the same options kept that was ended");
        app.footer(kConvertExamples);
    }

    Result<int> run() override {
        if (source_.scenes.size() < 2)
            return Error{"OUT is required; see overcast convert --help"};
        output_ = std::move(source_.scenes.back());
        source_.scenes.pop_back();
        if (const Result<Done> fine = check_output(output_); !fine)
            return fine.error();
        if (const Result<Done> fine = source_.check(); !fine)
            return fine.error();
        std::vector<NamedFile> files = source_.files();
        files.push_back({"output", output_});
        if (const Result<Done> fine = check_distinct(files); !fine)
            return fine.error();
        const Result<BackendOptions> backend_options = backend_.resolve();
        if (!backend_options)
            return backend_options.error();
        const Result<LogLevel> level = log_.resolve();
        if (!level)
            return level.error();
        if (const Result<Done> fine = check_host_memory(); !fine)
            return fine.error();
        const LogSink log = standard_error_log(*level);
        if (extension_of(output_) == ".ovc")
            prepare_process(*backend_options);
        const Result<Done> done = convert(*backend_options, log);
        if (!done)
            return done.error();
        return kExitOk;
    }

private:
    Result<Done> check_host_memory() const {
        if (backend_.host_memory.empty())
            return go_on_ ? Result<Done>(Error{"--continue goes with --host-memory"})
                          : Result<Done>(Done{});
        if (extension_of(output_) != ".ovc")
            return Error{
                fmt::format("--host-memory goes with an output in .ovc, not with '{}'", output_)};
        return check_streams(source_);
    }

    Result<Done> convert(const BackendOptions& options, const LogSink& log) {
        if (options.host_bytes > 0)
            return go_on_ ? continue_streamed(source_, options, log, output_)
                          : convert_streamed(source_, options, log, output_);
        return extension_of(output_) == ".ovc"
                   ? convert_to_scene_file(source_, options, log, output_)
                   : convert_to_mesh(source_, log, output_, log_.quiet());
    }

    SceneArguments source_;
    std::string output_;
    bool go_on_ = false;
    LogArguments log_;
    BackendArguments backend_; // for .ovc
};

} // namespace

std::unique_ptr<Subcommand> make_convert() {
    return std::make_unique<Convert>();
}

} // namespace ovc
