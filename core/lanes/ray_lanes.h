// SPDX-License-Identifier: Apache-2.0
// RayLanes: looks at eight rays at once, by the widest vectors that the processor has: which of
// them may meet the scene, and what they are in its frame.
#pragma once

#include "core/box.h"
#include "core/ray.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

/// Eight rays. Arrays are [axis][lane].
struct RayLanes {
    static constexpr int kCount = 8;
    /// Returns a bit for each of the first `count` lanes.
    static constexpr uint32_t first(size_t count) { return (1u << count) - 1; }

    alignas(64) double org[3][kCount], dir[3][kCount];
    alignas(64) double t_min[kCount], t_max[kCount];
    alignas(64) double from[kCount]; // t_min, or more where hits up to some place do not count
};

/// Fills in all lanes with eight rays, each of which begins at its t_min. A t_min or t_max of -0
/// becomes 0.
void gather(const Ray* const* rays, RayLanes& lanes);

/// A box as the lanes read it.
struct LanesBox {
    double lo[3], hi[3];

    LanesBox() = default;
    explicit LanesBox(const Box& box)
        : lo{box.lo.x, box.lo.y, box.lo.z}, hi{box.hi.x, box.hi.y, box.hi.z} {}
};

/// The scene that rays set out for.
struct LanesScene {
    bool is_empty = true;
    double padding = 0; // of `padded`
    LanesBox bounds{}, padded{};
};

/// A bit for each lane. Those of a lane that is not valid do not matter.
struct LanesAhead {
    uint32_t valid; // Ray::valid()
    uint32_t walks; // can_walk() of kdtree/restart.h
    uint32_t meets; // clip() of core/exact/triangle.h leaves something of it in the padded box
};

/// Returns what the functions named above return for each ray.
LanesAhead look_ahead(const LanesScene& scene, const RayLanes& rays);

/// A frame, a box in it, and how far from the frame's origin a ray's sums may come.
struct LanesFrame {
    LanesBox box{}; // in the world
    double origin[3] = {0, 0, 0};
    double scale = 1;
    double max_reach = 0;
    float no_ray = 0, undecidable = 0; // what t_end is where there is none
};

/// Eight rays in a frame, one behind the other as gpu/trace/local_ray.h has them.
struct LocalRows {
    static constexpr int kOrg = 0, kEnd = 3, kDir = 4, kWord = 7; // places in a row
    alignas(64) float rows[RayLanes::kCount][8];
};

/// Fills in all rows, with the same bits on every processor, from `from` and t_max of the rays.
/// words: the last word of each row.
void to_frame(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
              LocalRows& local);

/// Returns the functions per width of vectors that the processor has, the widest last: for tests.
using LookAhead = LanesAhead (*)(const LanesScene&, const RayLanes&);
using ToFrame = void (*)(const LanesFrame&, const RayLanes&, const uint32_t*, LocalRows&);
using Gather = void (*)(const Ray* const*, RayLanes&);
std::vector<LookAhead> ways_to_look_ahead();
std::vector<ToFrame> ways_to_frame();
std::vector<Gather> ways_to_gather();

} // namespace ovc
