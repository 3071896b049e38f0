// SPDX-License-Identifier: Apache-2.0
// BuiltScene: its sums, and the triangles that it is built from.
#include "plugin/built_scene.h"

#include "core/stopwatch.h"

#include <algorithm>

namespace ovc {

uint64_t BuiltScene::level2_bytes() const {
    uint64_t bytes = 0;
    for (const Page& page : pages)
        bytes += page.bytes();
    return bytes;
}

uint64_t BuiltScene::largest_page_bytes() const {
    uint64_t bytes = 0;
    for (const Page& page : pages)
        bytes = std::max(bytes, page.bytes());
    return bytes;
}

uint64_t BuiltScene::host_bytes() const {
    return level2_bytes() + level1.reference_count() * sizeof(TriangleId) +
           level1.leaves.size() * sizeof(Leaf) + level1.nodes.size() * sizeof(KdNode);
}

Hittable take_hittable(BuiltScene& scene, BuildProgress* progress) {
    const Stopwatch watch;
    Hittable hittable;
    hittable.triangles = hittable_triangles(scene.soup, &scene.dropped, &hittable.bounds, progress);
    scene.twins = Twins::take_out(scene.soup, hittable.triangles, progress);
    scene.triangles = hittable.triangles.size();
    scene.seconds_level1 = watch.seconds();
    return hittable;
}

} // namespace ovc
