// SPDX-License-Identifier: Apache-2.0
// Rays that a software renderer's kernel takes through the tree two at a time
// (docs/decisions/0012): which rays suit, and what happens to two that do not go alike.
#pragma once

#include "gpu/trace/local_ray.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

inline constexpr uint32_t kPacketRays = 2;

/// Whether most neighbours in the sequence go nearly the same way: their directions differ by less
/// than 1/16, and they begin nearer to each other than 1/16 of the frame. Looks at a sample.
bool coherent(std::span<const LocalRay> rays);
bool coherent(std::span<const ResumedRay> rays);

/// A ray of a pass, and the slot behind all rays that it went to.
struct Parted {
    uint32_t ray;
    uint32_t slot;
};

/// Moves the second ray of a packet whose rays go into different octants, or farthest along
/// different axes, behind the first `rays` of `slots`, to at most `most` slots, and makes `slots`
/// as many whole blocks as that takes; in its place is no ray. A few rays that find no room may
/// stay, undecidable. None, and nothing moved, where they would be more.
std::optional<std::vector<Parted>> part_packets(std::vector<LocalRay>& slots, size_t rays,
                                                size_t most);
std::optional<std::vector<Parted>> part_packets(std::vector<ResumedRay>& slots, size_t rays,
                                                size_t most);

} // namespace ovc
