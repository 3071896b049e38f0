// SPDX-License-Identifier: Apache-2.0
// Sends rays to their next stop, and takes their answers, until all are done.
#include "plugin/ranks/routed_call.h"

#include "core/exact/triangle.h"
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "plugin/ranks/visit_arrays.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace ovc {
namespace {

constexpr size_t kBlock = 4096; // rays
/// So many blocks, and one a thread at least, are begun together, so that short calls are sent as
/// one message.
constexpr size_t kMinBlocks = 2;

/// A message has so many visits at most, and at least so many while more rays are to come: enough
/// that its cost is that of its bytes, and so few that other ranks begin early.
constexpr size_t kMaxMessage = size_t(1) << 14, kMinMessage = size_t(1) << 12;

constexpr size_t kCopyGrain = 2048; // rays a task that only copies

/// How many rays of a rank are at another one at once, those of all calls together. All ranks may
/// send theirs to the same one, whose memory for them this bounds: 24 MiB for two ranks, 48 MiB for
/// many, and beyond 128 of them 400 KiB for each. With fewer, ranks wait for each other's batches.
size_t max_away(uint32_t ranks) {
    return std::clamp<size_t>((size_t(1) << 19) / ranks, size_t(1) << 12, size_t(1) << 18);
}

} // namespace

void RoutedCall::give_up() {
    for (uint32_t rank = 0; rank < outgoing_.size(); ++rank)
        counts_.away[rank] -= std::exchange(outgoing_[rank].away, 0);
}

void RoutedCall::begin(const RoutedRays& rays) {
    assert(rays.rays.size() <= RoutedRays::kMaxRays);
    assert(rays.hits.empty() || rays.occluded.empty());
    constexpr size_t kKeptRays = size_t(1) << 18;
    give_up();
    if (count() > kKeptRays)
        blocks_ = {}, next_ = {}, end_ = {};
    rays_ = rays;
    call_ = counts_.calls++;
    next_block_ = 0;
    std::ranges::fill(rays_.hits, Hit());
    std::ranges::fill(rays_.occluded, uint8_t(0));
    blocks_.resize(std::max(blocks_.size(), (count() + kBlock - 1) / kBlock));
    next_.resize(count());
    end_.resize(count());
    for (Outgoing& outgoing : outgoing_)
        outgoing.waiting.clear();
    answered_.clear();
    for (uint32_t number = 0; number < sent_.size(); ++number)
        answered_.push_back(number);
    done_ = 0;
}

bool RoutedCall::find_stops() {
    const size_t blocks = (count() + kBlock - 1) / kBlock;
    if (next_block_ == blocks)
        return false;
    const size_t first = next_block_;
    next_block_ = std::min(blocks, first + std::max(thread_count(), kMinBlocks));
    begin_blocks(first, next_block_);
    send_off(next_block_ == blocks ? 1 : kMinMessage);
    return true;
}

/// Finds the stops of these blocks' rays, which then wait for their first visit. Invalid rays go to
/// this rank, which knows what to answer them.
void RoutedCall::begin_blocks(size_t first, size_t last) {
    const auto end_of = [&](size_t block) { return std::min(count(), (block + 1) * kBlock); };
    parallel_for(last - first, 1, [&](size_t from, size_t to) {
        for (size_t block = first + from; block < first + to; ++block) {
            std::vector<Stop>& stops = blocks_[block].stops;
            stops.clear();
            stops.reserve(kBlock);
            std::array<Ray, StopFinder::kPacket> packet;
            for (size_t i = block * kBlock; i < end_of(block); i += packet.size()) {
                const size_t rays = std::min(packet.size(), end_of(block) - i);
                for (size_t j = 0; j < rays; ++j)
                    packet[j] = rays_.rays[i + j];
                next_[i] = uint32_t(stops.size());
                ranks_.finder.find(std::span(packet).first(rays), stops,
                                   std::span(end_).subspan(i, rays));
                std::copy_n(end_.begin() + ptrdiff_t(i), rays - 1,
                            next_.begin() + ptrdiff_t(i + 1));
            }
        }
    });
    for (size_t i = first * kBlock; i < end_of(last - 1); ++i)
        done_ += !go_on(uint32_t(i));
}

/// Lets the ray wait for its next visit. Returns false where it needs none.
bool RoutedCall::go_on(uint32_t ray) {
    if (next_[ray] == end_[ray] || (is_any() && rays_.occluded[ray]))
        return false;
    const Stop& stop = blocks_[ray / kBlock].stops[next_[ray]];
    if (!is_any() && stop.t > rays_.hits[ray].t)
        return false;
    ++next_[ray];
    outgoing_[stop.rank].waiting.push_back(ray);
    return true;
}

/// Sends what waits, to ranks for which at least so many rays do.
void RoutedCall::send_off(size_t min_visits) {
    for (uint32_t to = 0; to < outgoing_.size(); ++to) {
        const size_t max = to == ranks_.transport.rank() ? RoutedRays::kMaxRays
                                                         : max_away(ranks_.transport.ranks());
        while (outgoing_[to].waiting.size() >= min_visits && counts_.away[to] < max)
            send_some(to, outgoing_[to]);
    }
}

void RoutedCall::send_some(uint32_t to, Outgoing& outgoing) {
    const uint32_t number = number_of(to, outgoing.waiting);
    const size_t visits = sent_[number].rays.size();
    outgoing.away += visits;
    counts_.away[to] += visits;
    counts_.visits_elsewhere += to == ranks_.transport.rank() ? 0 : visits;
    ranks_.transport.send(to, visits_of(number));
}

/// Moves the last rays that wait to a message's place in sent_, which it returns.
uint32_t RoutedCall::number_of(uint32_t to, std::vector<uint32_t>& waiting) {
    if (answered_.empty()) {
        answered_.push_back(uint32_t(sent_.size()));
        sent_.emplace_back();
    }
    const uint32_t number = answered_.back();
    answered_.pop_back();
    const auto from = waiting.end() - ptrdiff_t(std::min(waiting.size(), kMaxMessage));
    sent_[number].to = to;
    sent_[number].rays.assign(from, waiting.end());
    waiting.erase(from, waiting.end());
    return number;
}

Message RoutedCall::visits_of(uint32_t number) const {
    const std::span<const uint32_t> rays = sent_[number].rays;
    const Exclusions& without = rays_.without;
    const uint32_t arrays = (without.after.empty() ? 0 : VisitArrays::kHasAfter) |
                            (without.skip.empty() ? 0 : VisitArrays::kHasSkip) |
                            (without.sieves.masks.empty() ? 0 : VisitArrays::kHasMasks);
    Message message({is_any() ? MessageKind::AnyVisits : MessageKind::NearestVisits, call_, number,
                     uint32_t(rays.size()), arrays},
                    VisitArrays::bytes(rays.size(), arrays));
    const VisitArrays visits(message);
    parallel_for(rays.size(), kCopyGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            Ray ray = rays_.rays[rays[i]];
            // A nearer hit may have a t that rounds to the same double, from a little above it.
            if (!is_any() && rays_.hits[rays[i]].is_hit())
                ray.t_max =
                    std::min(ray.t_max, std::nextafter(rays_.hits[rays[i]].t,
                                                       std::numeric_limits<double>::infinity()));
            visits.rays[i] = ray;
            if (!visits.after.empty())
                visits.after[i] = {without.after[rays[i]].t, without.after[rays[i]].id};
            if (!visits.skip.empty())
                visits.skip[i] = without.skip[rays[i]];
            if (!visits.masks.empty())
                visits.masks[i] = without.sieves.masks[rays[i]];
        }
    });
    return message;
}

Result<Done> RoutedCall::take(const Received& received) {
    const Message& message = received.message;
    if (message.kind() == MessageKind::Failure) {
        const auto told = message.items<const char>();
        Error error = error_of_text({told.data(), told.size()});
        error.message =
            format_text("{}: {}", ranks_.transport.name_of(received.from), error.message);
        return error;
    }
    const Sent& sent = sent_.at(message.head().number);
    assert(sent.rays.size() == message.head().count);
    if (message.kind() == MessageKind::Occlusions) {
        const auto occluded = message.items<const uint8_t>();
        for (size_t i = 0; i < sent.rays.size(); ++i)
            rays_.occluded[sent.rays[i]] = occluded[i];
    } else {
        const auto hits = message.items<const Hit>();
        for (size_t i = 0; i < sent.rays.size(); ++i)
            if (hits[i].is_hit() && is_nearer(sent.rays[i], hits[i]))
                rays_.hits[sent.rays[i]] = hits[i];
    }
    for (const uint32_t ray : sent.rays)
        done_ += !go_on(ray);
    outgoing_[sent.to].away -= sent.rays.size();
    counts_.away[sent.to] -= sent.rays.size();
    answered_.push_back(message.head().number);
    return Done{};
}

/// Whether the hit comes before the ray's nearest so far, in the order of exact t, mesh and prim.
bool RoutedCall::is_nearer(uint32_t ray, const Hit& hit) const {
    const Hit& best = rays_.hits[ray];
    if (!best.is_hit() || hit.t != best.t || hit.id == best.id)
        return hit.nearer_than(best);
    // Rounded, they are equal; the corners tell which comes first.
    const PreparedRay p(rays_.rays[ray]);
    Nearest nearest(p);
    nearest.offer(ranks_.soup.triangle(best.id), best.id);
    nearest.offer(ranks_.soup.triangle(hit.id), hit.id);
    return nearest.best().found.hit.id == hit.id;
}

Result<Done> take_answers(const Routing& ranks, RoutedCounts& counts,
                          std::span<RoutedCall* const> calls, std::chrono::milliseconds patience) {
    const bool was_idle = ranks.is_idle();
    const Stopwatch watch;
    const std::vector<Received> all = ranks.transport.answers.take(patience);
    if (was_idle && ranks.is_idle())
        counts.seconds_waiting += watch.seconds();
    for (const Received& received : all)
        for (RoutedCall* const call : calls)
            if (received.message.head().call == call->number())
                if (const Result<Done> done = call->take(received); !done)
                    return done;
    if (const std::optional<Error> lost = ranks.transport.lost())
        return *lost;
    for (RoutedCall* const call : calls)
        call->send_off();
    return Done{};
}

} // namespace ovc
