// SPDX-License-Identifier: Apache-2.0
// overcast convert: any input to .ply or .obj.
#include "host/arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/output.h"
#include "host/scene_source.h"
#include "importers/importer.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace ovc {

static constexpr const char* kExamples = R"(Examples:
  overcast convert kitchen.obj kitchen.ply
  overcast convert dragon.ply.gz dragon.ply
  overcast convert plants plants.ply          a generated scene, for other programs)";

/// Known before a big file is read for nothing.
static Result<Done> check_mesh_output(const std::filesystem::path& path) {
    std::string extension = path.extension();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension != ".ply" && extension != ".obj")
        return Error{
            fmt::format("the output file '{}' ends in neither .ply nor .obj", path.string())};
    return check_writable("output", path);
}

/// What the scene has and no output keeps, for a person; empty: nothing.
static std::string left_out(const Scene& scene) {
    std::vector<std::string> items;
    const auto add = [&](size_t count, std::string_view what) {
        if (count > 0)
            items.push_back(fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"));
    };
    // Every scene has the grey that a file without materials gets.
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

Result<int> run_convert(const Arguments& arguments) {
    CLI::App app{"Writes the triangles of a scene as .ply (binary) or .obj.", "overcast convert"};
    SceneArguments source;
    std::string output;
    bool quiet = false;
    source.add_to(app, "IN");
    app.add_option("OUT", output, "The file to write; replaced only once the new one is complete")
        ->required();
    app.add_flag("--quiet", quiet, "Print nothing but warnings and errors");
    app.footer(kExamples);
    const Result<Parsed> parsed = parse_arguments(app, arguments);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;

    if (const Result<Done> fine = check_mesh_output(output); !fine)
        return fine.error();
    if (const Result<Done> fine = source.check(); !fine)
        return fine.error();
    std::vector<NamedFile> files = source.files();
    files.push_back({"output", output});
    if (const Result<Done> fine = check_distinct(files); !fine)
        return fine.error();
    const Result<Scene> scene = open_scene(source, standard_error_log(/* chatty= */ false));
    if (!scene)
        return scene.error();
    if (const Result<Done> saved = save(*scene, output); !saved)
        return saved.error();
    if (const std::string items = left_out(*scene); !items.empty() && !quiet)
        fmt::print(stderr, "overcast: only triangles are kept; left out of {}: {}\n", output,
                   items);
    return kExitOk;
}

} // namespace ovc
