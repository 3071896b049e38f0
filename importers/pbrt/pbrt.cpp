// SPDX-License-Identifier: Apache-2.0
// The PBRT reader reads the scene descriptions of pbrt-v1 to v4, as docs/reference/pbrt.md says.
#include "importers/pbrt/assembly.h"
#include "importers/pbrt/interpret/interpreter.h"
#include "importers/pbrt/look/exposure.h"
#include "importers/readers.h"
#include "importers/sound_meshes.h"

#include <fmt/format.h>

#include <cassert>

namespace ovc {

/// Forty files that each include the next one twice make 2^40 includes. An include that a scene
/// repeats so often brings some triangles, so their limit bounds the includes as well.
static constexpr uint64_t kTrianglesOfAnInclude = 100;

Result<Scene> read_pbrt(const std::filesystem::path& path, const ImportOptions& options) {
    pbrt::Diagnostics diagnostics(options.log, options.strict);
    pbrt::Tokens tokens(path.parent_path(), diagnostics, options.files,
                        options.max_triangles / kTrianglesOfAnInclude);
    pbrt::Interpreter interpreter(tokens, diagnostics, options);
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
    if (const Result<Done> fine = pbrt::check_census(census, options.max_triangles); !fine)
        return Error{fmt::format("{}: {}", path.string(), fine.error().message)};
    pbrt::assemble(std::move(world), census, scene);
    assert(has_sound_meshes(scene));
    if (const float exposure = pbrt::fitting_exposure(scene); exposure != 1) {
        pbrt::expose(scene, exposure);
        scene.exposure = exposure;
    }
    scene.instancing = {census.unique, census.instances};
    if (scene.soup.triangle_count() == 0)
        say(options.log, LogLevel::Warning, fmt::format("{}: it has no triangles", path.string()));
    return scene;
}

} // namespace ovc
