// SPDX-License-Identifier: Apache-2.0
// System: the texels of a system of the thesis, and the facts that its kernel must know. Each
// system holds the whole scene, in one frame, as one array of texels.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "core/soup.h"
#include "gpu/bvh/pairs.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"
#include "plugin/overcast.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace ovc::thesis {

struct System {
    Texels texels;
    uint64_t references = 0;  // triangles, each counted once per place that lists it
    uint32_t stack_depth = 4; // of the kernel, where it has a stack
    uint64_t max_rounds = std::numeric_limits<uint64_t>::max(); // of the kernel's loop for any ray
};

/// Returns the structure's name on the command line and in messages.
const char* name_of(ovc_structure structure);

/// Returns a lower bound of the bytes that the system's texels take for so many triangles.
uint64_t min_bytes(ovc_structure structure, uint64_t triangles);

/// Returns the system over `whole`, which has triangles. Error: more than its kernel can count.
Result<System> build_system(ovc_structure structure, const Soup& soup, const Leaf& whole,
                            BuildProgress* progress = nullptr);

/// Returns about how many units of progress the build makes.
uint64_t work_of(ovc_structure structure, uint64_t triangles);

/// Boxes, cells and planes are this much wider in the frame, whose half-extent is 1: 2^-18 = 64u.
/// The kernels' own roundings move a point of a ray by at most 21u against a plane: the origin u,
/// the plane's place 3u, the direction 2u over the frame's width, the reciprocal and the product
/// 13u, the difference 2u (docs/design/numerics.md, "Boxes").
inline constexpr double kWider = 0x1p-18;

/// Returns the triangles of `whole` in its frame, rounded as the kernel sees them.
std::vector<LocalTriangle> local_triangles(const Soup& soup, const Leaf& whole);

/// Appends the three texels of triangle `id`. mark: bits to set besides
/// (shaders/thesis/single_triangle.glsl).
void append(Texels& texels, const LocalTriangle& triangle, uint32_t id, uint32_t mark = 0);

inline uint32_t bits(float x) {
    return std::bit_cast<uint32_t>(x);
}
inline uvec4 texel(const vec3& v, uint32_t w = 0) {
    return {bits(v.x), bits(v.y), bits(v.z), w};
}

} // namespace ovc::thesis
