// SPDX-License-Identifier: Apache-2.0
#include "host/render/sight.h"

#include <algorithm>

namespace ovc {

Sight::Sight(const Scene& scene, bool with_cutouts)
    : scene_(scene),
      has_masks_(std::ranges::any_of(scene.soup.chunks,
                                     [](const Chunk& chunk) { return chunk.mask() != 0; })),
      by_paths_(scene, Cutouts::Asked::ByPaths),
      by_shadow_rays_(scene, Cutouts::Asked::ByShadowRays),
      path_filter_(with_cutouts && by_paths_.any() ? &by_paths_ : nullptr),
      shadow_filter_(with_cutouts && by_shadow_rays_.any() ? &by_shadow_rays_ : nullptr) {}

Sieves Sight::of(std::span<const Path> paths, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {.filters = filter(path_filter_)};
    room.resize(paths.size());
    std::ranges::transform(paths, room.begin(), [](const Path& path) {
        return path.reflected ? kSeenInReflections : kSeenByCamera;
    });
    return {.masks = room, .filters = filter(path_filter_)};
}

Sieves Sight::of(std::span<const Shadow> shadows, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {.filters = filter(shadow_filter_)};
    room.resize(shadows.size());
    std::ranges::transform(shadows, room.begin(), [&](const Shadow& shadow) {
        return shadow.light == kNone                  ? kShadowsEmitters
               : scene_.lights[shadow.light].stand_in ? kShadowsStandIns
                                                      : kShadowsLights;
    });
    return {.masks = room, .filters = filter(shadow_filter_)};
}

Sieves Sight::of_camera(size_t rays, std::vector<uint32_t>& room) const {
    if (!has_masks_)
        return {.filters = filter(path_filter_)};
    room.assign(rays, kSeenByCamera);
    return {.masks = room, .filters = filter(path_filter_)};
}

} // namespace ovc
