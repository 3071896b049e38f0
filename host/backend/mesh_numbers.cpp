// SPDX-License-Identifier: Apache-2.0
// Translates numbers of meshes between a scene and the library, where they differ.
#include "host/backend/mesh_numbers.h"

#include <cassert>

namespace ovc {

void MeshNumbers::add(uint32_t in_library) {
    assert(in_library >= in_scene_.size());
    differ_ = differ_ || in_library != count();
    in_scene_.resize(in_library, kNone);
    in_scene_.push_back(count());
    in_library_.push_back(in_library);
}

void MeshNumbers::forget_from(uint32_t mesh) {
    assert(mesh <= count());
    for (uint32_t m = mesh; m < count(); ++m)
        in_scene_[in_library_[m]] = kNone;
    in_library_.resize(mesh);
}

void MeshNumbers::to_scene(std::span<Hit> hits) const {
    for (Hit& hit : hits.first(differ_ ? hits.size() : 0))
        hit.id = in_scene(hit.id);
}

bool LibraryFilter::keep(std::span<const uint64_t> rays, std::span<const Hit> hits,
                         std::span<uint8_t> keep) {
    if (!numbers_.differ())
        return filter_.keep(rays, hits, keep);
    std::vector<Hit> in_scene(hits.begin(), hits.end());
    numbers_.to_scene(in_scene);
    return filter_.keep(rays, in_scene, keep);
}

LibraryExclusions::LibraryExclusions(const MeshNumbers& numbers, std::span<const TriangleId> skip,
                                     std::span<const Hit> after)
    : skip_(skip), after_(after) {
    if (!numbers.differ())
        return;
    for (const TriangleId& id : skip)
        skip_room_.push_back(numbers.in_library(id));
    for (Hit hit : after) {
        hit.id = numbers.in_library(hit.id);
        after_room_.push_back(hit);
    }
    skip_ = skip_room_;
    after_ = after_room_;
}

} // namespace ovc
