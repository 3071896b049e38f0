// SPDX-License-Identifier: Apache-2.0
// WarpModel: what a GPU's warps and caches do with the steps that rays take, and how many rays a
// second that allows at most.
#pragma once

#include "tests/warp/replay.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ovc {

inline constexpr size_t kWarpLanes = 32;
inline constexpr uint64_t kLineBytes = 128;

/// A GPU, as its data sheet has it.
struct Gpu {
    std::string name;
    double multiprocessors = 0; // with an L1 each
    double warps_a_cycle = 0;   // instructions that a multiprocessor issues in a cycle
    double hertz = 0;
    double l1_bytes_a_cycle = 0; // of a multiprocessor
    double l2_bytes_a_second = 0;
    double memory_bytes_a_second = 0;
    uint64_t l1_bytes = 0;
    uint64_t l2_bytes = 0;
};

/// How warps run. resident_warps: of a multiprocessor, in turn. refill: lanes that are done take
/// the next slot after a look every few rounds, from a share of the slots that their warp has.
struct WarpVariant {
    bool branches = false;
    bool packets = false;
    bool refill = false;
};

/// The work of one kind of warps, over all rays.
struct WarpWork {
    uint64_t rays = 0;
    uint64_t warp_rounds = 0; // rounds of warps: as many as the lane that takes longest
    uint64_t lane_rounds = 0; // rounds of lanes that have a slot under way
    uint64_t node_rounds = 0; // rounds of warps in which a lane is at a node, with branches
    uint64_t pair_rounds = 0; // the same at a pair
    uint64_t lines = 0;       // 128-byte lines that warps fetch
    uint64_t l1_misses = 0;
    uint64_t l2_misses = 0;

    double active_lanes() const {
        return warp_rounds ? double(lane_rounds) / double(warp_rounds) : 0;
    }
    double lines_a_ray() const { return double(lines) / double(rays); }
};

/// Runs the slots through warps of 32 lanes on one multiprocessor, whose L1 and L2 are as large as
/// the GPU's. rays: of all slots.
WarpWork run_warps(const WarpVariant& variant, std::span<const Steps> slots, uint64_t rays,
                   const Gpu& gpu);

/// The max rays a second that the GPU's issue of instructions, its caches and its memory allow.
struct RayRate {
    double issue = 0;
    double l1 = 0;
    double l2 = 0;
    double memory = 0;
    double bound() const;
    const char* bound_by() const;
};
RayRate rate_of(const WarpVariant& variant, const WarpWork& work, const Gpu& gpu);

} // namespace ovc
