// SPDX-License-Identifier: Apache-2.0
// Sends rays to their next stop, and takes their answers, until all are done.
#include "plugin/ranks/routed_call.h"

#include "core/exact/triangle.h"
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

namespace ovc {

/// A message has so many visits at most: enough that its cost is that of its bytes, and so few that
/// its memory is reused, which the C library returns to the system from 128 KiB on.
static constexpr size_t kMaxMessage = size_t(1) << 10;

/// How many rays of a rank are at another one at once. All ranks may send theirs to the same one,
/// whose memory for them this bounds: 24 MiB for two ranks, 48 MiB for many, and beyond 128 of them
/// 400 KiB for each. With fewer, ranks wait for each other's batches.
static size_t max_away(uint32_t ranks) {
    return std::clamp<size_t>((size_t(1) << 19) / ranks, size_t(1) << 12, size_t(1) << 18);
}

RoutedCall::RoutedCall(const Routing& ranks, const RoutedRays& rays, uint32_t call,
                       CallWatch& watch)
    : ranks_(ranks), rays_(rays), call_(call), watch_(watch), ways_(ranks.transport.ranks()) {
    assert(rays.rays.size() <= RoutedRays::kMaxRays);
    assert(rays.hits.empty() || rays.occluded.empty());
}

Result<Done> RoutedCall::run() {
    const size_t count = rays_.rays.size();
    std::ranges::fill(rays_.hits, Hit());
    std::ranges::fill(rays_.occluded, uint8_t(0));
    find_stops();
    for (size_t ray = 0; ray < count; ++ray)
        done_ += !go_on(uint32_t(ray));
    send_off();
    while (done_ < count) {
        if (const Result<Done> done = wait(); !done)
            return done;
        send_off();
    }
    return Done{};
}

/// Sets the stops of all rays. Invalid rays go to this rank, which knows what to answer.
void RoutedCall::find_stops() {
    constexpr size_t kBlock = 4096;
    const size_t count = rays_.rays.size(), blocks = (count + kBlock - 1) / kBlock;
    next_.resize(count);
    end_.resize(count);
    std::vector<std::vector<Stop>> found(blocks);
    parallel_for(blocks, 1, [&](size_t first, size_t last) {
        std::vector<Stop> stops;
        for (size_t i = first * kBlock; i < std::min(count, last * kBlock); ++i) {
            const Ray ray = rays_.rays[i];
            stops.assign(1, {-std::numeric_limits<double>::infinity(), ranks_.transport.rank()});
            if (ray.valid())
                ranks_.finder.find(ray, stops);
            std::vector<Stop>& all = found[i / kBlock];
            next_[i] = uint32_t(all.size());
            all.insert(all.end(), stops.begin(), stops.end());
            end_[i] = uint32_t(all.size());
        }
    });
    for (size_t block = 0; block < blocks; ++block) {
        const auto before = uint32_t(stops_.size());
        stops_.insert(stops_.end(), found[block].begin(), found[block].end());
        for (size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
            next_[i] += before, end_[i] += before;
    }
}

/// Lets the ray wait for its next visit. Returns false where it needs none.
bool RoutedCall::go_on(uint32_t ray) {
    if (next_[ray] == end_[ray] || (is_any() && rays_.occluded[ray]))
        return false;
    const Stop& stop = stops_[next_[ray]];
    if (!is_any() && stop.t > rays_.hits[ray].t)
        return false;
    ++next_[ray];
    ways_[stop.rank].waiting.push_back(ray);
    return true;
}

void RoutedCall::send_off() {
    for (uint32_t to = 0; to < ranks_.transport.ranks(); ++to) {
        const size_t max = to == ranks_.transport.rank() ? RoutedRays::kMaxRays
                                                         : max_away(ranks_.transport.ranks());
        while (!ways_[to].waiting.empty() && ways_[to].away < max)
            send_some(to, ways_[to]);
    }
}

void RoutedCall::send_some(uint32_t to, Way& way) {
    const size_t count = std::min(way.waiting.size(), kMaxMessage);
    std::vector<RankVisit> visits(count);
    parallel_for(count, 2048, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            visits[i] = visit_of(way.waiting[i]);
    });
    way.waiting.erase(way.waiting.begin(), way.waiting.begin() + ptrdiff_t(count));
    way.away += count;
    visits_elsewhere_ += to == ranks_.transport.rank() ? 0 : count;
    ranks_.transport.send(to,
                          Message(is_any() ? MessageKind::AnyVisits : MessageKind::NearestVisits,
                                  call_, std::span<const RankVisit>(visits)));
}

RankVisit RoutedCall::visit_of(uint32_t ray) const {
    const Exclusion without = rays_.without[ray];
    RankVisit visit{rays_.rays[ray],
                    without.skip,
                    without.after.id,
                    without.after.t,
                    rays_.without.sieves[ray].mask,
                    ray};
    // A nearer hit may have a t that rounds to the same double, from a little above it.
    if (!is_any())
        visit.ray.t_max =
            std::min(visit.ray.t_max,
                     std::nextafter(rays_.hits[ray].t, std::numeric_limits<double>::infinity()));
    return visit;
}

Result<Done> RoutedCall::wait() {
    const bool was_idle = ranks_.is_idle();
    const Stopwatch watch;
    const std::vector<Received> all = ranks_.transport.answers.take(std::chrono::milliseconds(50));
    if (was_idle && ranks_.is_idle())
        seconds_waiting_ += watch.seconds();
    for (const Received& received : all)
        if (received.message.call() == call_)
            if (const Result<Done> done = take(received); !done)
                return done;
    if (const std::optional<Error> lost = ranks_.transport.lost())
        return *lost;
    return watch_.go_on(done_, rays_.rays.size());
}

Result<Done> RoutedCall::take(const Received& received) {
    const Message& message = received.message;
    if (message.kind() == MessageKind::Failure) {
        const auto told = message.items<char>();
        Error error = error_of_text({told.data(), told.size()});
        error.message =
            format_text("{}: {}", ranks_.transport.name_of(received.from), error.message);
        return error;
    }
    const auto came_back = [&](uint32_t ray) {
        --ways_[received.from].away;
        done_ += !go_on(ray);
    };
    if (message.kind() == MessageKind::Occlusions)
        for (const OcclusionThere& there : message.items<OcclusionThere>()) {
            rays_.occluded[there.slot] = there.occluded != 0;
            came_back(there.slot);
        }
    else
        for (const HitThere& there : message.items<HitThere>()) {
            take_hit(there);
            came_back(there.slot);
        }
    return Done{};
}

void RoutedCall::take_hit(const HitThere& there) {
    if (there.hit.is_hit() && is_nearer(there.slot, there.hit))
        rays_.hits[there.slot] = there.hit;
}

/// Whether the hit comes before the ray's nearest so far, in the order of exact t, mesh and prim.
bool RoutedCall::is_nearer(uint32_t ray, const Hit& hit) const {
    const Hit& best = rays_.hits[ray];
    if (!best.is_hit() || hit.t != best.t || hit.id == best.id || !ranks_.certified)
        return hit.nearer_than(best);
    // Rounded, they are equal; the corners tell which comes first.
    const PreparedRay p(rays_.rays[ray]);
    Nearest nearest(p);
    nearest.offer(ranks_.soup.triangle(best.id), best.id);
    nearest.offer(ranks_.soup.triangle(hit.id), hit.id);
    return nearest.best().found.hit.id == hit.id;
}

} // namespace ovc
