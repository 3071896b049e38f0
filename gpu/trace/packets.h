// SPDX-License-Identifier: Apache-2.0
// Packets: two rays that a software renderer's kernel takes through the tree together
// (docs/decisions/0012). Decides which rays suit, and parts two that do not go alike.
#pragma once

#include "core/function_ref.h"
#include "core/system/system_pages.h"
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
/// Does the same for rays that ray_at() returns.
bool coherent(size_t rays, FunctionRef<LocalRay(size_t)> ray_at);

/// A ray of a pass that was moved, and its new slot behind all rays.
struct Parted {
    uint32_t ray;
    uint32_t slot;
};

/// Moves the second ray of a packet behind the first `rays` of `slots` if its two rays go into
/// different octants, or farthest along different axes; OVC_NO_RAY takes its place. Grows `slots`
/// to as many whole blocks as that takes, at most `max_slots` slots. A few rays that find no room
/// may stay; the kernel then leaves them undecided. Returns the rays that were moved, or nothing,
/// with none moved, if more than a few would stay.
std::optional<std::vector<Parted>> part_packets(PagedVector<LocalRay>& slots, size_t rays,
                                                size_t max_slots);
std::optional<std::vector<Parted>> part_packets(PagedVector<ResumedRay>& slots, size_t rays,
                                                size_t max_slots);

} // namespace ovc
