// SPDX-License-Identifier: Apache-2.0
#include "host/render/sight.h"

#include <algorithm>

namespace ovc {

Sight::Sight(const Scene& scene)
    : has_masks_(std::ranges::any_of(scene.soup.chunks,
                                     [](const Chunk& chunk) { return chunk.mask() != 0; })) {}

Sieves Sight::of(std::span<const Path> paths, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {};
    room.resize(paths.size());
    std::ranges::transform(paths, room.begin(), [](const Path& path) {
        return path.reflected ? kSeenInReflections : kSeenByCamera;
    });
    return {.masks = room};
}

Sieves Sight::of(std::span<const Shadow> shadows, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {};
    room.resize(shadows.size());
    std::ranges::transform(shadows, room.begin(), [](const Shadow& shadow) {
        return shadow.light == kNone ? kShadowsEmitters : kShadowsLights;
    });
    return {.masks = room};
}

Sieves Sight::of_camera(size_t rays, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {};
    room.assign(rays, kSeenByCamera);
    return {.masks = room};
}

} // namespace ovc
