// SPDX-License-Identifier: Apache-2.0
// The rays that contenders are timed with: what a renderer would ask first, made once for all.
#pragma once

#include "core/ray.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

enum class RayQuery { Nearest, Occlusion };

struct RaySet {
    std::string name;
    RayQuery query;
    std::vector<Ray> rays;
};

/// Three sets, in the order of pixel_order:
///   primary   the nearest hit, one ray through the centre of each pixel;
///   shadow    occlusion, one ray from each hit pixel to the scene's first light;
///   diffuse   the nearest hit, one ray from each hit pixel, distributed as the cosine to its
///   normal.
/// `reference` answers the primary rays that the other two begin at. The same scene, camera and
/// size give the same rays bit for bit. Rays begin a little off the surface, farther than float32
/// errs, so that no contender needs to be told which triangle to skip. The scene has a light
/// (asserted).
Result<std::vector<RaySet>> make_ray_sets(const Scene& scene, const Camera& camera, uint32_t width,
                                          uint32_t height, Backend& reference);

/// "edges": the nearest hit, one ray from each pixel that hits, from the camera at a corner of the
/// triangle there or a point of its edges: what falls through where neighbours do not meet. Where
/// the camera is, and what is said above, hold.
Result<RaySet> make_edge_set(const Scene& scene, const Camera& camera, uint32_t width,
                             uint32_t height, Backend& reference);

/// The first of them alone, named after how many rays it has: "primary 1,024".
RaySet make_primary_set(const Camera& camera, uint32_t width, uint32_t height);

} // namespace ovc
