// SPDX-License-Identifier: Apache-2.0
// overcast convert: any input to .ply or .obj.
#include "host/arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/output.h"
#include "host/scene_source.h"
#include "importers/importer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

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

Result<int> run_convert(const Arguments& arguments) {
    CLI::App app{"Writes the triangles of a scene as .ply (binary) or .obj.", "overcast convert"};
    std::string source, output;
    app.add_option("IN", source, "A file or a test scene's name")->required();
    app.add_option("OUT", output, "The file to write; replaced only once the new one is complete")
        ->required();
    app.footer(kExamples);
    const Result<Parsed> parsed = parse_arguments(app, arguments);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;

    if (const Result<Done> fine = check_mesh_output(output); !fine)
        return fine.error();
    const Result<Scene> scene = open_scene(source, standard_error_log(/* chatty= */ false));
    if (!scene)
        return scene.error();
    if (const Result<Done> saved = save(*scene, output); !saved)
        return saved.error();
    return kExitOk;
}

} // namespace ovc
