// SPDX-License-Identifier: Apache-2.0
// The PBRT reader reads the scene descriptions of pbrt-v1 to v4, as docs/reference/pbrt.md says.
#include "importers/pbrt/assembly.h"
#include "importers/pbrt/interpret/interpreter.h"
#include "importers/readers.h"
#include "importers/scene_file/sound_meshes.h"

#include <fmt/format.h>

#include <cassert>

namespace ovc {

/// Forty files that each include the next one twice make 2^40 includes. An include that a scene
/// repeats so often brings some triangles, so their limit bounds the includes as well.
static constexpr uint64_t kTrianglesOfAnInclude = 100;

/// Reads a scene that was found not to stream once more. Its warnings have been said.
static Result<Scene> read_held(const std::filesystem::path& path, ImportOptions options) {
    options.log = {};
    options.streaming = nullptr;
    return read_pbrt(path, options);
}

Result<Scene> read_pbrt(const std::filesystem::path& path, const ImportOptions& options) {
    pbrt::Diagnostics diagnostics(options.log, options.strict);
    pbrt::Tokens tokens(path.parent_path(), diagnostics, options.files,
                        options.max_triangles / kTrianglesOfAnInclude);
    std::optional<pbrt::StreamedShapes> streamed;
    if (options.streaming)
        streamed.emplace(*options.streaming);
    pbrt::Interpreter interpreter(tokens, diagnostics, options, streamed ? &*streamed : nullptr);
    if (!tokens.open(path) || !interpreter.run())
        return diagnostics.error();

    Scene scene;
    scene.name = path.stem().string();
    interpreter.fill(scene);
    if (diagnostics.failed())
        return diagnostics.error();
    pbrt::World world = interpreter.take_world();
    world.top.name = scene.name;
    const pbrt::Census census = pbrt::take_census(world);
    Result<Done> fine = pbrt::check_census(census, options.max_triangles, !streamed);
    const bool is_to_be_held = streamed && census.shares_corners();
    if (fine && is_to_be_held)
        fine = pbrt::check_conversion(census, options.streaming->host_bytes);
    if (!fine)
        return Error{fmt::format("{}: {}", path.string(), fine.error().message)};
    if (is_to_be_held)
        return read_held(path, options);
    pbrt::MeshOutput output(scene, census.triangles, options.streaming);
    pbrt::assemble(std::move(world), census, output, streamed ? &*streamed : nullptr);
    if (streamed && streamed->error())
        return *streamed->error();
    if (!output.is_wanted())
        return Error{"cancelled", ErrorKind::Cancelled};
    scene.omissions = diagnostics.omissions();
    assert(streamed || has_sound_meshes(scene));
    if (const float exposure = output.exposure(); exposure != 1) {
        pbrt::expose(scene, vec3(exposure));
        scene.exposure = exposure;
    }
    scene.instancing = {census.unique, census.instances};
    if (census.triangles == 0)
        say(options.log, LogLevel::Warning, fmt::format("{}: it has no triangles", path.string()));
    return scene;
}

} // namespace ovc
