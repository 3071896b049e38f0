// SPDX-License-Identifier: Apache-2.0
#include "tests/warp/warp_model.h"

#include <algorithm>
#include <array>
#include <list>
#include <unordered_map>

namespace ovc {
namespace {

constexpr size_t kResidentWarps = 16; // of 64, with some hundred registers a lane
constexpr size_t kRefillSlots = 16;   // that a lane takes on average
constexpr size_t kRefillRounds = 3;   // between two looks (shaders/trace.glsl)

// Instructions of a step for a warp: arithmetic of the sources, counted by hand, and what decodes
// and sorts. A packet shares the fetch, the decoding and the sorting of a node.
constexpr double kNodeInstructions = 120, kNodeOfFurtherRay = 50;
constexpr double kPairInstructions = 150, kPairOfFurtherRay = 130;
constexpr double kRoundInstructions = 30; // loops, the stack

/// A cache of whole lines in which the line that was used longest ago goes first.
class Cache {
public:
    explicit Cache(uint64_t bytes) : lines_(std::max<uint64_t>(bytes / kLineBytes, 1)) {}

    /// Returns whether the line is there, and brings it in if not.
    bool touch(uint64_t line) {
        const auto known = places_.find(line);
        if (known != places_.end()) {
            order_.splice(order_.begin(), order_, known->second);
            return true;
        }
        if (order_.size() == lines_) {
            places_.erase(order_.back());
            order_.pop_back();
        }
        order_.push_front(line);
        places_[line] = order_.begin();
        return false;
    }

private:
    size_t lines_;
    std::list<uint64_t> order_;
    std::unordered_map<uint64_t, std::list<uint64_t>::iterator> places_;
};

/// A warp with its share of the slots.
class Warp {
public:
    Warp(const WarpVariant& variant, std::span<const Steps> slots)
        : variant_(variant), slots_(slots) {
        for (Lane& lane : lanes_)
            take(lane);
    }

    bool is_done() const { return done_; }

    /// Goes a round. Adds to `work` and calls fetch(line) for each line that the lanes want.
    template <class Fetch>
    void go_round(WarpWork& work, Fetch&& fetch) {
        // With branches a round is a step; without, two units are fetched, and both kinds of code
        // run.
        const size_t fetches = variant_.branches ? 1 : 2;
        bool at_node = false, at_pair = false;
        size_t active = 0;
        for (size_t k = 0; k < fetches; ++k) {
            wanted_.clear();
            for (Lane& lane : lanes_) {
                if (!lane.slot || lane.next == lane.slot->units.size())
                    continue;
                active += k == 0;
                (lane.slot->is_pair[lane.next] ? at_pair : at_node) = true;
                wanted_.push_back(uint64_t(lane.slot->units[lane.next++]) * OVC_UNIT_BYTES /
                                  kLineBytes);
            }
            std::ranges::sort(wanted_);
            wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
            for (const uint64_t line : wanted_)
                fetch(line);
        }
        if (active > 0) {
            work.warp_rounds += 1;
            work.lane_rounds += active;
            work.node_rounds += at_node || !variant_.branches;
            work.pair_rounds += at_pair || !variant_.branches;
        }
        if (variant_.refill && ++rounds_ % kRefillRounds == 0)
            for (Lane& lane : lanes_)
                if (lane.slot && lane.next == lane.slot->units.size())
                    take(lane);
        done_ = std::ranges::none_of(lanes_, [](const Lane& lane) {
            return lane.slot && lane.next < lane.slot->units.size();
        });
        if (done_ && next_ < slots_.size()) { // all lanes ended between two looks
            for (Lane& lane : lanes_)
                take(lane);
            done_ = false;
        }
    }

private:
    struct Lane {
        const Steps* slot = nullptr;
        size_t next = 0; // unit; the first is the tree's header, which all lanes read at once
    };

    void take(Lane& lane) {
        lane.slot = next_ < slots_.size() ? &slots_[next_++] : nullptr;
        lane.next = 1;
    }

    WarpVariant variant_;
    std::span<const Steps> slots_;
    size_t next_ = 0;
    size_t rounds_ = 0;
    bool done_ = false;
    std::array<Lane, kWarpLanes> lanes_;
    std::vector<uint64_t> wanted_;
};

} // namespace

WarpWork run_warps(const WarpVariant& variant, std::span<const Steps> slots, uint64_t rays,
                   const Gpu& gpu) {
    WarpWork work;
    work.rays = rays;
    Cache l1(gpu.l1_bytes), l2(gpu.l2_bytes);
    const auto fetch = [&](uint64_t line) {
        ++work.lines;
        if (l1.touch(line))
            return;
        ++work.l1_misses;
        work.l2_misses += !l2.touch(line);
    };
    const size_t share = kWarpLanes * (variant.refill ? kRefillSlots : 1);
    size_t next = 0;
    std::vector<Warp> warps;
    while (next < slots.size() || !warps.empty()) {
        while (warps.size() < kResidentWarps && next < slots.size()) {
            const size_t count = std::min(share, slots.size() - next);
            warps.emplace_back(variant, slots.subspan(next, count));
            next += count;
        }
        for (Warp& warp : warps)
            warp.go_round(work, fetch);
        std::erase_if(warps, [](const Warp& warp) { return warp.is_done(); });
    }
    return work;
}

double RayRate::bound() const {
    return std::min({issue, l1, l2, memory});
}

const char* RayRate::bound_by() const {
    const double least = bound();
    return least == issue ? "issue" : least == l1 ? "L1" : least == l2 ? "L2" : "memory";
}

RayRate rate_of(const WarpVariant& variant, const WarpWork& work, const Gpu& gpu) {
    const double node = kNodeInstructions + (variant.packets ? kNodeOfFurtherRay : 0);
    const double pair = kPairInstructions + (variant.packets ? kPairOfFurtherRay : 0);
    // Without branches a round is a step to a node and a step to either.
    const double nodes = double(work.node_rounds) * (variant.branches ? 1 : 2);
    const double instructions = kRoundInstructions * double(work.warp_rounds) + node * nodes +
                                pair * double(work.pair_rounds);
    const auto rate = [&](double work_of_all, double a_second) {
        return work_of_all > 0 ? a_second * double(work.rays) / work_of_all : 1e30;
    };
    RayRate found;
    found.issue = rate(instructions, gpu.multiprocessors * gpu.warps_a_cycle * gpu.hertz);
    found.l1 = rate(double(work.lines * kLineBytes),
                    gpu.multiprocessors * gpu.l1_bytes_a_cycle * gpu.hertz);
    found.l2 = rate(double(work.l1_misses * kLineBytes), gpu.l2_bytes_a_second);
    found.memory = rate(double(work.l2_misses * kLineBytes), gpu.memory_bytes_a_second);
    return found;
}

} // namespace ovc
