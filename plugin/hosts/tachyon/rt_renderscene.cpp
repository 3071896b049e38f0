// SPDX-License-Identifier: Apache-2.0
// Stands before Tachyon's rt_renderscene in a program that has this library preloaded: whatever has
// filled the scene, its triangles go to Overcast, and Tachyon renders.
//
// usage: LD_PRELOAD=libovercast_tachyon.so PROGRAM..., or the command overcast-tachyon
#include "plugin/hosts/tachyon/taken_triangles.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include <dlfcn.h>

namespace ovc::tachyon {

static void prepare(scenedef& scene) {
    static const Intersect intersect = triangle_intersect();
    const auto start = std::chrono::steady_clock::now();
    const SingleRays* rays = take_triangles(scene, intersect, settings_from_environment());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    if (!rays)
        return;
    const ovc_statistics s = rays->statistics();
    std::printf("Overcast: %llu triangles in %llu leaves, %.4f seconds, %s\n",
                static_cast<unsigned long long>(s.triangles),
                static_cast<unsigned long long>(s.leaves), took.count(), rays->renderer().c_str());
}

} // namespace ovc::tachyon

extern "C" __attribute__((visibility("default"))) void rt_renderscene(SceneHandle scene) {
    using Render = void (*)(SceneHandle);
    const auto render = reinterpret_cast<Render>(dlsym(RTLD_NEXT, "rt_renderscene"));
    try {
        if (!render)
            throw std::runtime_error("there is no Tachyon behind this library: it is preloaded "
                                     "into a program that is linked with Tachyon's");
        ovc::tachyon::prepare(*static_cast<scenedef*>(scene));
    } catch (const std::exception& e) {
        std::fprintf(stderr, "overcast: %s\n", e.what());
        std::exit(EXIT_FAILURE);
    }
    render(scene);
}
