// SPDX-License-Identifier: Apache-2.0
// RoutedCall: a call's rays on their way from rank to rank. A ray visits the ranks whose pages it
// comes by, the nearest first, and after each visit its answer comes home: here. It goes on as long
// as another rank may have a nearer hit.
#pragma once

#include "core/exclusions.h"
#include "core/ray_span.h"
#include "plugin/ranks/stops.h"
#include "plugin/ranks/transport/transport.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace ovc {

/// All routed calls of a scene have these in common.
struct Routing {
    const Soup& soup; // whose corners decide between hits of equal t
    const StopFinder& finder;
    Transport& transport;
    std::function<bool()> is_idle; // whether this rank traces nothing just now
};

/// Counts over all routed calls of a scene.
struct RoutedCounts {
    explicit RoutedCounts(uint32_t ranks) : away(ranks) {}

    uint32_t calls = 0;       // so many were begun
    std::vector<size_t> away; // how many rays are at each rank
    uint64_t visits_elsewhere = 0;
    double seconds_waiting = 0; // while there was nothing to do but to wait for other ranks
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
    RoutedCall(const Routing& ranks, RoutedCounts& counts)
        : ranks_(ranks), counts_(counts), outgoing_(ranks.transport.ranks()) {}
    ~RoutedCall() { give_up(); }
    RoutedCall(const RoutedCall&) = delete;

    /// Begins to answer the rays, all of which find_stops() has to send on their way. One call may
    /// follow the other; an earlier one is given up.
    void begin(const RoutedRays& rays);
    /// Finds the stops of the next rays, and sends them. Returns false where there are no more.
    bool find_stops();
    /// Sends the rays that wait, as far as other ranks have room for them.
    void send_off() { send_off(1); }
    /// Forgets the rays that are on their way, as the destructor does; answers to them are not
    /// taken.
    void give_up();
    /// Takes answers to rays of this call. Error: a rank cannot trace.
    Result<Done> take(const Received& received);

    /// The number of the call in MessageHead::call.
    uint32_t number() const { return call_; }
    size_t count() const { return rays_.rays.size(); }
    size_t done() const { return done_; }
    bool is_done() const { return done_ == count(); }

private:
    /// Messages that wait to go to a rank, and how many of its rays are there.
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

    bool is_any() const { return rays_.hits.empty(); }
    void begin_blocks(size_t first, size_t last);
    bool go_on(uint32_t ray);
    void send_off(size_t min_visits);
    void send_some(uint32_t to, Outgoing& outgoing);
    uint32_t number_of(uint32_t to, std::vector<uint32_t>& waiting);
    Message visits_of(uint32_t number) const;
    bool is_nearer(uint32_t ray, const Hit& hit) const;

    const Routing& ranks_;
    RoutedCounts& counts_;
    RoutedRays rays_;       // of the call under way
    uint32_t call_ = kNone; // its number
    size_t next_block_ = 0; // whose stops are not found yet
    // Below, the memory of short calls is kept for the next.
    std::vector<Block> blocks_;
    std::vector<uint32_t> next_, end_; // of each ray, into the stops of its block
    std::vector<Outgoing> outgoing_;   // to each rank
    std::vector<Sent> sent_;
    std::vector<uint32_t> answered_; // numbers that are free again
    size_t done_ = 0;
};

/// Hands the answers that have come to those of the calls whose they are, and sends on what these
/// have; waits for the first answer so long at most. Error: a rank is lost, or cannot trace.
Result<Done> take_answers(const Routing& ranks, RoutedCounts& counts,
                          std::span<RoutedCall* const> calls, std::chrono::milliseconds patience);

} // namespace ovc
