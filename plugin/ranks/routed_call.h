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

#include <chrono>
#include <cstdint>
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
    Exclusions without; // without filters
    std::span<Hit> hits;
    std::span<uint8_t> occluded;
};

class RoutedCall {
public:
    RoutedCall(const Routing& ranks, CallWatch& watch)
        : ranks_(ranks), watch_(watch), outgoing_(ranks.transport.ranks()) {}

    /// Answers all rays. Error: the call is cancelled, a rank is lost, or one cannot trace. Another
    /// call may follow in any case.
    Result<Done> run(const RoutedRays& rays);

    uint64_t visits_elsewhere() const { return visits_elsewhere_; }
    /// Returns how long there was nothing to do but to wait for other ranks.
    double seconds_waiting() const { return seconds_waiting_; }

private:
    /// What waits to go to a rank, and how many rays are there.
    struct Outgoing {
        std::vector<uint32_t> waiting; // rays
        size_t away = 0;
    };
    /// A message whose answer has not come yet. Its number is the place in sent_.
    struct Sent {
        uint32_t to = 0;
        std::vector<uint32_t> rays;
    };
    /// Rays that lie side by side in the call, and the stops of one after those of the other.
    struct Block {
        std::vector<Stop> stops;
    };

    void begin(const RoutedRays& rays);
    bool is_any() const { return rays_.hits.empty(); }
    size_t count() const { return rays_.rays.size(); }
    void begin_blocks(size_t first, size_t last);
    bool go_on(uint32_t ray);
    void send_off(size_t min_visits);
    void send_some(uint32_t to, Outgoing& outgoing);
    uint32_t number_of(uint32_t to, std::vector<uint32_t>& waiting);
    Message visits_of(uint32_t number) const;
    Result<Done> take_answers(std::chrono::milliseconds patience);
    Result<Done> take(const Received& received);
    bool is_nearer(uint32_t ray, const Hit& hit) const;
    Result<Done> wait();

    const Routing& ranks_;
    CallWatch& watch_;
    RoutedRays rays_;   // of the call under way
    uint32_t call_ = 0; // its number
    // Below, the memory of short calls is kept for the next.
    std::vector<Block> blocks_;
    std::vector<uint32_t> next_, end_; // of each ray, into the stops of its block
    std::vector<Outgoing> outgoing_;   // to each rank
    std::vector<Sent> sent_;
    std::vector<uint32_t> answered_; // numbers that are free again
    size_t done_ = 0;
    uint64_t visits_elsewhere_ = 0;
    double seconds_waiting_ = 0;
};

} // namespace ovc
