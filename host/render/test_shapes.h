// SPDX-License-Identifier: Apache-2.0
// Shapes for tests of the renderers.
#pragma once

#include "core/scene.h"

#include <array>
#include <utility>

namespace ovc {

/// Returns two triangles. Seen from their front, the corners run counterclockwise.
inline Chunk quad(dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    return Chunk::owning(dvec3(0), {vec3(a), vec3(b), vec3(c), vec3(a), vec3(c), vec3(d)});
}

/// Adds a closed box with a material of its own; its fronts are outside or inside.
inline void add_box(Scene& scene, Material material, dvec3 lo, dvec3 hi, bool outside = true) {
    scene.materials.push_back(std::move(material));
    const auto at = [&](int i) {
        return dvec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    };
    for (const auto& [a, b, c, d] : {std::array{4, 5, 7, 6},
                                     {1, 0, 2, 3},
                                     {5, 1, 3, 7},
                                     {0, 4, 6, 2},
                                     {6, 7, 3, 2},
                                     {0, 1, 5, 4}})
        scene.add_mesh("side", uint32_t(scene.materials.size() - 1),
                       outside ? quad(at(a), at(b), at(c), at(d))
                               : quad(at(d), at(c), at(b), at(a)));
}

} // namespace ovc
