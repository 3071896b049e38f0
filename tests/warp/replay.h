// SPDX-License-Identifier: Apache-2.0
// Replays rays through the kernel's own source, compiled as C++, and tells which units each of them
// fetches: the counting build of the kernel.
#pragma once

#include "core/vec.h"
#include "gpu/trace/local_ray.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The steps of a slot of a pass: of a ray, or of a packet of two.
struct Steps {
    uint32_t prim = 0;        // w of the answer of the first ray
    uint32_t second_prim = 0; // of the second, if there is one
    uint32_t rounds = 0;
    std::vector<uint32_t> units; // in the order of fetching; the first is the header
    std::vector<bool> is_pair;   // of each of them
};

/// A kernel in which steps have branches or not, and rays go alone or in packets of two.
struct ReplayedVariant {
    bool any_hit = false;
    bool branches = false;
    bool packets = false;
};

/// pool: the top-level tree and the pages, as on the device, in one buffer. rays: in the frame that
/// all share; an even number for packets. Returns the steps of each ray, or each packet. On all
/// cores.
std::vector<Steps> replay(const ReplayedVariant& variant, std::span<const uvec4> pool,
                          std::span<const LocalRay> rays);

} // namespace ovc
