// SPDX-License-Identifier: Apache-2.0
// RoutedCall: a call's rays on their way from rank to rank. A ray visits the ranks whose pages it
// comes by, the nearest first, and after each visit its answer comes home: here. It goes on as long
// as another rank may have a nearer hit.
#pragma once

#include "core/exclusions.h"
#include "core/ray_span.h"
#include "plugin/ranks/stops.h"
#include "plugin/ranks/transport.h"
#include "plugin/structure/call_watch.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

namespace ovc {

/// What routed calls of a scene have in common.
struct Routing {
    const Soup& soup; // whose corners decide between hits of equal t
    bool certified;
    const StopFinder& finder;
    Transport& transport;
    std::function<bool()> is_idle; // whether this rank traces nothing just now
};

/// The rays of a call, at most kMaxRays, and where their answers go: one of the last two is empty.
struct RoutedRays {
    static constexpr size_t kMaxRays = size_t(1) << 20;

    RaySpan rays;
    const Exclusions& without; // without filters
    std::span<Hit> hits;
    std::span<uint8_t> occluded;
};

class RoutedCall {
public:
    /// call: a number that no other of this rank had of late.
    RoutedCall(const Routing& ranks, const RoutedRays& rays, uint32_t call, CallWatch& watch);

    /// Answers all rays. Error: the call is cancelled, a rank is lost, or one cannot trace.
    Result<Done> run();

    uint64_t visits_elsewhere() const { return visits_elsewhere_; }
    /// Returns how long there was nothing to do but to wait for other ranks.
    double seconds_waiting() const { return seconds_waiting_; }

private:
    /// What waits to go to a rank, and what is there.
    struct Way {
        std::deque<uint32_t> waiting; // rays
        size_t away = 0;
    };

    bool is_any() const { return rays_.hits.empty(); }
    void find_stops();
    bool go_on(uint32_t ray);
    void send_off();
    void send_some(uint32_t to, Way& way);
    RankVisit visit_of(uint32_t ray) const;
    Result<Done> take(const Received& received);
    void take_hit(const HitThere& there);
    bool is_nearer(uint32_t ray, const Hit& hit) const;
    Result<Done> wait();

    const Routing& ranks_;
    const RoutedRays& rays_;
    const uint32_t call_;
    CallWatch& watch_;
    std::vector<Stop> stops_;    // of all rays
    std::vector<uint32_t> next_; // of each ray, into stops_
    std::vector<uint32_t> end_;  // likewise
    std::vector<Way> ways_;      // to each rank
    size_t done_ = 0;
    uint64_t visits_elsewhere_ = 0;
    double seconds_waiting_ = 0;
};

} // namespace ovc
