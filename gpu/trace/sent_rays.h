// SPDX-License-Identifier: Apache-2.0
// SentRays: the rays of a pass in the layout that the kernel reads. Whoever has rays for a pass
// writes them here, eight at a time, beside the pass before.
#pragma once

#include "core/lanes/ray_lanes.h"
#include "core/system/system_pages.h"
#include "gpu/trace/answers.h"
#include "gpu/trace/local_ray.h"
#include "gpu/trace/packets.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace ovc {

/// A ray on its way, in the layout of shaders/layout.h. It is in the world's coordinates, finite,
/// and its direction has finite reciprocals, as can_walk() of kdtree/restart.h asks.
struct RayState {
    Ray ray{dvec3(0), 0, dvec3(0, 0, 1), -1}; // t_max < t_min: no ray
    std::array<uint32_t, 2> zeros{};
    uint32_t skip = OVC_NO_TRIANGLE; // number of a triangle that the ray does not see
    uint32_t asks = 0; // the resume key, or 0; OVC_RAY_ANY_HIT is added if any hit will do

    bool any_hit() const { return (asks & OVC_RAY_ANY_HIT) != 0; }
    uint32_t key() const { return asks & ~OVC_RAY_ANY_HIT; }
};
static_assert(sizeof(RayState) == OVC_RAY_TEXELS * sizeof(uvec4));

/// Eight ray states; lanes that are not set may hold anything. Hits before RayLanes::from or beyond
/// t_max are of no interest.
struct RayStates {
    RayLanes rays;
    std::array<uint32_t, RayLanes::kCount> skip, asks; // as in RayState

    /// Sets the first `count` lanes, 1 or more, to the rays at(lane), which skip nothing. The
    /// addresses are those of rays, which are read at once. asks: as RayState has it.
    template <class At>
    void set(size_t count, uint32_t asks_for, At&& at) {
        std::array<const Ray*, RayLanes::kCount> all;
        all.fill(at(0));
        for (size_t lane = 1; lane < count; ++lane)
            all[lane] = at(lane);
        gather(all.data(), rays);
        skip.fill(OVC_NO_TRIANGLE);
        asks.fill(asks_for);
    }
    RayState state(int lane) const;
};

/// Returns the frame of a leaf for to_frame().
LanesFrame lanes_frame(const Leaf& leaf);

/// Fills in the rows of those states that have a bit in `which`, in the frame of a top-level tree:
/// that of the scene or, where there is one, that behind the way in. Others may hold anything.
void to_tree_frame(const LanesFrame& scene, const Portal* way_in, const RayStates& states,
                   uint32_t which, LocalRows& local);
/// Returns the ray in a row.
LocalRay local_ray_in(const LocalRows& local, int lane);

/// How a kernel wants its rays. The frames outlive all that is sent so.
struct RayForm {
    enum class Kind {
        World,   // RayState: the kernel changes frames
        Local,   // LocalRay: in the frame of the top-level tree
        Resumed, // ResumedRay: the same, and rays may wait for pages
    };
    Kind kind = Kind::Local;
    const Leaf* scene = nullptr;    // the frame of the scene
    const Portal* way_in = nullptr; // the frame of the top-level tree where it is another
};

class SentRays {
public:
    /// Makes room for so many rays of a form, all of which are no rays until put() is called.
    void reset(const RayForm& form, size_t rays);
    /// Writes those of the states that have a bit in `which`, to the places from `at` on; returns
    /// their number. Several threads may write to different places.
    size_t put(size_t at, const RayStates& states, uint32_t which);
    /// Closes the holes between blocks of `block_rays` places, of which each has counts[b] rays at
    /// its beginning: they come to follow each other, in order. Sets how many rays there are.
    void close_holes(size_t block_rays, std::span<const size_t> counts);
    size_t size() const { return size_; }

    /// Whether all rays ask if anything is hit, as whoever put them says.
    bool all_any_hit() const { return all_any_hit_; }
    void set_all_any_hit(bool all) { all_any_hit_ = all; }
    /// Whether rays suit packets (gpu/trace/packets.h).
    bool are_coherent() const;
    /// Parts packets, which are not parted yet; there are at most `max_slots` slots. Returns
    /// whether packets are of use.
    bool part(size_t max_slots);
    /// Takes part() back.
    void unpart();
    std::span<const Parted> parted() const { return parted_; }
    /// How many slots rays take: more than size() where packets were parted.
    size_t slots() const { return parted_.empty() ? size_ : parted_.back().slot + 1; }

    /// Whole blocks of rays, as the kernel reads them.
    std::span<const std::byte> bytes() const;
    /// Returns a copy of the first rays, of which none is parted.
    SentRays first(size_t rays) const;

private:
    /// Sets how many rays there are, of those that there is room for.
    void set_size(size_t rays);
    LocalRay local_ray_of(size_t i) const;

    RayForm form_;
    LanesFrame frame_;
    size_t size_ = 0;
    bool all_any_hit_ = false;
    using Rays =
        std::variant<PagedVector<LocalRay>, PagedVector<ResumedRay>, PagedVector<RayState>>;
    Rays rays_;       // in whole blocks
    Rays other_rays_; // to which close_holes() copies them
    std::vector<Parted> parted_;
};

/// Writes all the states in a form: for callers to whom it does not matter how long that takes.
SentRays send(const RayForm& form, std::span<const RayState> states);

} // namespace ovc
