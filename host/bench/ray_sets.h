// SPDX-License-Identifier: Apache-2.0
// Makes the rays that contenders are timed with: those that a renderer would trace first.
#pragma once

#include "core/ray.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/backend/backend.h"

#include <array>
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

/// A backend's answers for a set: a hit of each ray, or whether it is occluded, as the query asks.
struct RaySetAnswers {
    std::vector<Hit> hits;
    std::vector<uint8_t> occluded;
};

/// Has the backend answer the set in one call. Error: the backend's.
Result<RaySetAnswers> answers_of(const RaySet& set, Backend& backend);

/// Returns the scene's own camera, or one that frames the whole scene, as `overcast render` does.
Camera own_or_framing_camera(const Scene& scene, uint32_t width, uint32_t height);

inline constexpr std::array<const char*, 3> kRaySetNames = {"primary", "shadow", "diffuse"};

/// Returns the sets of these names, each in the order of pixel_order():
///   primary   the nearest hit, one ray through the centre of each pixel;
///   shadow    occlusion, one ray from each hit pixel to the scene's first light, or to one over
///   the
///             camera's shoulder where the scene has none;
///   diffuse   the nearest hit, one ray from each hit pixel, cosine-distributed about the normal.
/// `reference` answers the primary rays, and the other two sets begin at its hits. The same scene,
/// camera and size give the same rays bit for bit. Rays begin a little off the surface, farther
/// than float32 errs, so that no contender needs to be told which triangle to skip. Error:
/// `reference` fails.
Result<std::vector<RaySet>> make_ray_sets(const Scene& scene, const Camera& camera, uint32_t width,
                                          uint32_t height, Backend& reference);

/// Returns the set "edges": nearest hits of one camera ray for each hit pixel, aimed at a corner of
/// the triangle there or at a point of its edges. Such rays slip through where neighbouring
/// triangles do not meet. `reference`, order and determinism are as above; no light is needed.
Result<RaySet> make_edge_set(const Scene& scene, const Camera& camera, uint32_t width,
                             uint32_t height, Backend& reference);

/// Returns the primary set alone, named after the number of its rays: "primary 1,024".
RaySet make_primary_set(const Camera& camera, uint32_t width, uint32_t height);

} // namespace ovc
