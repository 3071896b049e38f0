// SPDX-License-Identifier: Apache-2.0
// Opens test scenes by name and files by path.
#include "host/scene/scene_source.h"

#include "core/text/suggestion.h"
#include "host/arguments/arguments.h"
#include "host/scene/joined_scene.h"
#include "host/terminal/message.h"
#include "importers/importer.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <filesystem>
#include <system_error>

namespace ovc {

void SceneArguments::add_to(CLI::App& app, const char* name) {
    app.add_option(name, scenes,
                   "A file (.ply .obj .pbrt .pov, also .gz; .ovc, or what Assimp reads) or a test "
                   "scene's name; several make one scene")
        ->required();
    app.add_option(
           "--model", model,
           "For dragons-N and dragonball: the model they show instead of a generated one, a "
           "file or a test scene's name")
        ->type_name("SCENE");
    app.add_flag("--strict", strict,
                 "An error, not a warning: what is unknown, missing or unusable in a .pbrt, what "
                 "is not drawn "
                 "as its author meant in a .pov, and an image texture that cannot be read");
    app.add_option("--world", world,
                   "For .pbrt: which world of a file that has several; default: 1")
        ->type_name("N");
    app.add_option("--max-triangles", max_triangles,
                   "For .pbrt and .pov: refuse a scene of more, those of instances that share a "
                   "mesh counted once; default: "
                   "100000000")
        ->type_name("N");
    app.add_option("--tolerance", tolerance,
                   "For .pbrt and .pov: how far a triangle may lie off the round shape it stands "
                   "for, in radii, 0.0001 to 0.5; default: of .pbrt 0.00625, of .pov 0.0011, more "
                   "where that comes to millions of triangles")
        ->type_name("X");
    app.add_option(
           "--pov-version", pov_version,
           "For .pov: the version of the language, until the scene says #version; POV-Ray's "
           "+MV")
        ->type_name("X");
}

static Result<uint64_t> triangle_limit(const std::string& text) {
    if (text.empty())
        return kDefaultMaxTriangles;
    return parse_count("--max-triangles", text, 1, 4294967294);
}

static Result<std::optional<double>> tolerance_of(const std::string& text) {
    if (text.empty())
        return std::optional<double>();
    const Result<double> value = parse_real("--tolerance", text, kMinTolerance, kMaxTolerance);
    if (!value)
        return value.error();
    return std::optional(*value);
}

/// Parses a version of POV-Ray's language, from its first to whatever may come.
static Result<std::optional<double>> pov_version_of(const std::string& text) {
    if (text.empty())
        return std::optional<double>();
    const Result<double> value = parse_real("--pov-version", text, 1, 9);
    if (!value)
        return value.error();
    return std::optional(*value);
}

static Result<uint64_t> world_of(const std::string& text) {
    return text.empty() ? 1 : parse_count("--world", text, 1, 1'000'000'000);
}

Result<Done> SceneArguments::check() const {
    if (const Result<uint64_t> number = world_of(world); !number)
        return number.error();
    if (const Result<uint64_t> limit = triangle_limit(max_triangles); !limit)
        return limit.error();
    if (const Result<std::optional<double>> fine = tolerance_of(tolerance); !fine)
        return fine.error();
    if (const Result<std::optional<double>> fine = pov_version_of(pov_version); !fine)
        return fine.error();
    for (const std::string& scene : scenes)
        if (!model.empty() && !(is_test_scene(scene) && test_scene_entry(scene).takes_model))
            return Error{fmt::format("--model goes with the test scenes that show one (dragons-N, "
                                     "dragonball), not with '{}'",
                                     scene)};
    return Done{};
}

std::string SceneArguments::name() const {
    return fmt::format("{}", fmt::join(scenes, " + "));
}

std::vector<NamedFile> SceneArguments::files() const {
    std::vector<NamedFile> files;
    for (const std::string& scene : scenes)
        if (!is_test_scene(scene))
            files.push_back({"input", scene});
    if (!model.empty() && !is_test_scene(model))
        files.push_back({"model", model});
    return files;
}

bool SceneArguments::may_move() const {
    return std::ranges::any_of(scenes, [](const std::string& scene) {
        return is_test_scene(scene) ? test_scene_entry(scene).moves : ovc::may_move(scene);
    });
}

static Result<Scene> make_with_model(const std::string& name, const ImportOptions& options,
                                     const std::string& model) {
    const Result<Scene> loaded =
        is_test_scene(model) ? make_test_scene(model) : load(model, options);
    if (!loaded)
        return loaded.error();
    Result<Scene> scene = make_test_scene(name, &loaded->soup);
    return scene ? std::move(scene) : Error{fmt::format("{}: {}", model, scene.error().message)};
}

bool SceneArguments::is_one_scene_file() const {
    return scenes.size() == 1 && model.empty() && !is_test_scene(scenes[0]) &&
           std::filesystem::path(scenes[0]).extension() == ".ovc";
}

ImportOptions import_options(const SceneArguments& arguments, const LogSink& log,
                             FilesRead* files) {
    assert(arguments.check());
    ImportOptions options{log, arguments.strict};
    options.files = files;
    options.max_triangles = *triangle_limit(arguments.max_triangles);
    options.tolerance = *tolerance_of(arguments.tolerance);
    options.pov_version = *pov_version_of(arguments.pov_version);
    options.world = *world_of(arguments.world);
    options.moment = arguments.moment;
    return options;
}

Result<Scene> open_scene(const SceneArguments& arguments, const LogSink& log,
                         std::optional<ImageSize> size, FilesRead* files) {
    if (arguments.host_bytes > 0 && !arguments.is_one_scene_file())
        return Error{fmt::format("--host-memory goes with one .ovc file, which overcast convert "
                                 "makes; found '{}'",
                                 arguments.name())};
    ImportOptions options = import_options(arguments, log, files);
    options.size = size;
    options.host_bytes = arguments.host_bytes;
    std::vector<NamedScene> scenes;
    for (const std::string& name : arguments.scenes) {
        Result<Scene> scene = open_scene(name, options, arguments.model);
        if (!scene)
            return scene.error();
        scenes.push_back({name, std::move(*scene)});
    }
    return join(std::move(scenes), log);
}

Result<Scene> open_scene(const std::string& source, const ImportOptions& options,
                         const std::string& model) {
    if (is_test_scene(source))
        return model.empty() ? make_test_scene(source, nullptr, options.moment.clock)
                             : make_with_model(source, options, model);
    std::error_code ignored;
    if (std::filesystem::is_directory(source, ignored))
        return Error{fmt::format("'{}' is a directory, expected a file or a test scene", source)};
    const bool looks_like_a_name = source.find_first_of("./") == std::string::npos;
    if (looks_like_a_name && !source.empty() && !std::filesystem::exists(source, ignored)) {
        // There is no such file, so the error comes from the catalog, which knows the nearest name.
        const Result<Scene> none = make_test_scene(source);
        const std::string near = did_you_mean_file(source);
        return none || !near.empty() ? Error{fmt::format("there is no file '{}'{}", source, near)}
                                     : Error{fmt::format("there is no file '{}', and {}", source,
                                                         none.error().message)};
    }
    return load(source, options);
}

LogSink standard_error_log(LogLevel max_level) {
    return [max_level](LogLevel level, const std::string& message) {
        if (level > max_level)
            return;
        print_message((level == LogLevel::Warning ? "warning: " : "") + message);
    };
}

} // namespace ovc
