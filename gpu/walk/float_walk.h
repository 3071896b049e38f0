// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in float32: it follows shaders/traverse.glsl, has the same
// error bounds, and names the triangles of which one is the answer to a ray. A pass takes longer to
// begin than this does to answer some hundred rays.
#pragma once

#include "core/vec.h"
#include "gpu/trace/local_ray.h"
#include "shaders/layout.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

/// A tree without portals, of a whole scene or of a part, and the pages under it. All of it
/// outlives a walk.
struct WalkedTree {
    const uvec4* top = nullptr; // units of the top-level tree
    uint32_t header = 0;        // the unit of its own header
    const void* pages = nullptr;
    /// Returns the units of a page, which lie in memory.
    const uvec4* (*units_of)(const void* pages, uint32_t page) = nullptr;
};

/// The triangles, by their numbers, of which one is the answer to a ray. One that is not named is
/// certainly not the answer.
struct Named {
    static constexpr uint32_t kMax = OVC_MAX_NAMES;

    uint32_t certain = OVC_MISS; // the ray certainly hits it; OVC_MISS: none;
                                 // OVC_FLAGGED: the walk cannot tell which they are
    uint32_t count = 0;          // of the others, which the ray may hit, and sooner
    uint32_t further[kMax];
};

/// Walks rays, which are in the frame of the tree, to their nearest hits, or to any hits; names
/// what each of them finds. any_hit: further triangles are named only where no hit is certain. Any
/// thread.
using FloatWalk = void (*)(const WalkedTree& tree, const LocalRay* rays, size_t count, bool any_hit,
                           Named* named);

/// Returns the function for the best instructions that the processor has.
FloatWalk float_walk();
/// Returns one for each set of instructions that it has, the best last: for tests.
std::vector<FloatWalk> float_walks();

} // namespace ovc
