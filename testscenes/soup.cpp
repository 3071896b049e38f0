// SPDX-License-Identifier: Apache-2.0
// soup-N: N thousand slivers at random in the unit cube, the worst that a box hierarchy can meet.
#include "testscenes/corners.h"
#include "testscenes/random.h"
#include "testscenes/scenes.h"

#include "core/system/parallel.h"

namespace ovc {

Scene make_soup(uint32_t thousands) {
    const size_t count = size_t(thousands) * 1000;
    Corners corners(count * 3);
    parallel_for(count, 1024, [&](size_t first, size_t last) {
        for (size_t prim = first; prim < last; ++prim) {
            Random random(91, prim);
            const dvec3 centre{random.uniform(), random.uniform(), random.uniform()};
            const double length = random.uniform(0.01, 0.1), width = random.uniform(0.0005, 0.004);
            const dvec3 along = length * random.direction();
            const dvec3 across = width * random.direction();
            corners[prim * 3] = vec3(glm::clamp(centre - along, 0.0, 1.0));
            corners[prim * 3 + 1] = vec3(glm::clamp(centre + along, 0.0, 1.0));
            corners[prim * 3 + 2] = vec3(glm::clamp(centre + across, 0.0, 1.0));
        }
    });
    Scene scene;
    scene.materials.push_back({"sliver", vec3(0.7f, 0.6f, 0.4f), 0});
    scene.add_mesh("slivers", 0, Chunk::owning(dvec3(0), std::move(corners)));
    scene.lights.push_back({dvec3(3, 4, 5), vec3(3)});
    scene.camera = Camera{dvec3(1.3, 1.1, 2.2), dvec3(0.5), dvec3(0, 1, 0), 40};
    return scene;
}

} // namespace ovc
