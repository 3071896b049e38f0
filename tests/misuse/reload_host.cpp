// SPDX-License-Identifier: Apache-2.0
// Loads, uses and unloads the plugin many times. The resources of the process must not grow. There
// is only one thread, because oneTBB 2021.8 keeps 9 KiB of every thread that has run a loop and
// ended, with and without us. usage: reload_host libovercast.so TIMES
#include "plugin/overcast.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

constexpr int kSkipped = 77; // ctest's SKIP_RETURN_CODE

struct Resources {
    long resident_kib, threads, files, mappings;
};

long entries_of(const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
}

Resources resources() {
    long pages = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> pages >> resident;
    long mappings = 0;
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
        ++mappings;
    return {resident * 4, entries_of("/proc/self/task"), entries_of("/proc/self/fd"), mappings};
}

void print(int times, const Resources& now) {
    std::printf("%5d times: %ld KiB resident, %ld threads, %ld files, %ld mappings\n", times,
                now.resident_kib, now.threads, now.files, now.mappings);
}

/// Returns the name of the step that failed, or null.
const char* use(const ovc_api& api) {
    static const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const ovc_ray ray = {{0.25, 0.25, 1}, 0, {0, 0, -1}, HUGE_VAL};
    ovc_device device = nullptr;
    ovc_scene scene = nullptr;
    ovc_hit hit{};
    ovc_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.positions = positions;
    mesh.vertex_count = 3;
    if (api.create_device(nullptr, &device) != OVC_OK) {
        std::fprintf(stderr, "%s\n", api.last_error(nullptr));
        std::exit(kSkipped);
    }
    const bool right = api.create_scene(device, nullptr, &scene) == OVC_OK &&
                       api.add_mesh(scene, &mesh, nullptr) == OVC_OK &&
                       api.commit(scene) == OVC_OK &&
                       api.intersect(scene, &ray, 1, &hit, nullptr) == OVC_OK && hit.t == 1;
    api.commit(nullptr); // This leaves a message on this thread.
    api.destroy_scene(scene);
    api.destroy_device(device);
    return right ? nullptr : "a wrong answer";
}

/// Returns whether all went well.
bool load_and_use(const char* path) {
    void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    const auto get_api =
        library ? reinterpret_cast<ovc_get_api_function>(dlsym(library, "ovc_get_api")) : nullptr;
    const ovc_api* api = get_api ? get_api(OVC_ABI_VERSION) : nullptr;
    if (!api) {
        std::fprintf(stderr, "cannot load %s: %s\n", path, dlerror());
        return false;
    }
    const char* failed = use(*api);
    if (failed)
        std::fprintf(stderr, "%s\n", failed);
    dlclose(library);
    return !failed;
}

} // namespace

int main(int argc, char** argv) {
    const int times = argc > 2 ? std::atoi(argv[2]) : 0;
    if (times < 20) {
        std::fprintf(stderr, "usage: reload_host libovercast.so TIMES, 20 or more\n");
        return 1;
    }
    Resources settled{};
    for (int i = 1; i <= times; ++i) {
        if (!load_and_use(argv[1]))
            return 1;
        if (i == times / 10)
            print(i, settled = resources());
    }
    const Resources last = resources();
    print(times, last);
    // The size of the heap varies a little. A kilobyte lost each time would exceed this limit.
    const bool grown = last.resident_kib > settled.resident_kib + times * 9 / 10 ||
                       last.threads > settled.threads || last.files > settled.files ||
                       last.mappings > settled.mappings + 2;
    if (grown)
        std::fprintf(stderr, "that is more than after %d times\n", times / 10);
    return grown;
}
