// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/pov.h"

#include "importers/readers.h"
#include "importers/scene_file/sound_meshes.h"
#include "tests/fuzz/require.h"

namespace ovc {

/// More takes time, and finds nothing.
static constexpr uint64_t kMaxTrianglesFuzzed = 200'000;
static constexpr uint64_t kMaxWordsFuzzed = 20'000;

void fuzz_pov(const uint8_t* data, size_t size) {
    ImportOptions options;
    options.max_triangles = kMaxTrianglesFuzzed;
    std::string text(reinterpret_cast<const char*>(data), size);
    const Result<Scene> scene =
        parse_pov(std::move(text), "/nowhere/fuzz.pov", options, kMaxWordsFuzzed);
    if (!scene) {
        require(scene.error().message.starts_with("/"));
        return;
    }
    require(scene->camera.has_value());
    require(has_sound_meshes(*scene));
}

} // namespace ovc
