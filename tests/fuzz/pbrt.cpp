// SPDX-License-Identifier: Apache-2.0
// fuzz_pbrt: through a file in memory, for the reader takes files.
#include "tests/fuzz/pbrt.h"

#include "importers/readers.h"
#include "importers/scene_file/sound_meshes.h"
#include "tests/fuzz/require.h"

#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace ovc {

/// More takes time, and finds nothing.
static constexpr uint64_t kMaxFuzzed = 20000;

static void check_small_scene(const Scene& scene) {
    require(has_sound_meshes(scene));
    require(scene.soup.triangle_count() <= kMaxFuzzed);
}

void fuzz_pbrt(const uint8_t* data, size_t size) {
    static const int file = memfd_create("fuzz.pbrt", MFD_CLOEXEC);
    require(file >= 0 && ftruncate(file, 0) == 0);
    require(pwrite(file, data, size, 0) == ssize_t(size));
    const std::string path = "/proc/self/fd/" + std::to_string(file);
    const struct {
        bool strict;
        uint64_t world;
    } ways[] = {{false, 1}, {true, 1}, {false, 2}};
    for (const auto& way : ways) {
        ImportOptions options;
        options.strict = way.strict;
        options.world = way.world;
        options.max_triangles = kMaxFuzzed;
        const Result<Scene> scene = read_pbrt(path, options);
        if (scene)
            check_small_scene(*scene);
        else
            require(!scene.error().message.empty());
    }
}

} // namespace ovc
