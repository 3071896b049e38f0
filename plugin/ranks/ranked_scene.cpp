// SPDX-License-Identifier: Apache-2.0
// Cuts calls into routed calls, asks filters about what these bring home, and counts.
#include "plugin/ranks/ranked_scene.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "plugin/ranks/routed_stream.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace ovc {

RankedScene::RankedScene(const Soup& soup, RankedParts parts)
    : parts_(std::move(parts)),
      server_(*parts_.local, *parts_.transport, parts_.threads),
      routing_{soup, *parts_.finder, *parts_.transport, [this] { return server_.is_idle(); }},
      routed_(parts_.transport->ranks()),
      call_(routing_, routed_) {}

RankedScene::~RankedScene() {
    parts_.transport->close();
}

Result<Done> RankedScene::run(const RoutedRays& rays) {
    call_.begin(rays);
    Result<Done> done = wait_for_call();
    if (!done)
        call_.give_up();
    return done;
}

Result<Done> RankedScene::wait_for_call() {
    RoutedCall* const calls[] = {&call_};
    const auto take = [&](int milliseconds) {
        return take_answers(routing_, routed_, calls, std::chrono::milliseconds(milliseconds));
    };
    while (call_.find_stops())
        if (const Result<Done> done = take(0); !done)
            return done;
    while (!call_.is_done()) {
        if (const Result<Done> done = take(50); !done)
            return done;
        if (const Result<Done> done = watch_.go_on(call_.done(), call_.count()); !done)
            return done;
    }
    return Done{};
}

Result<Done> RankedScene::route(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                                std::span<uint8_t> occluded) {
    constexpr size_t kMax = RoutedRays::kMaxRays;
    const size_t parts = std::max<size_t>((rays.size() + kMax - 1) / kMax, 1);
    for (size_t part = 0; part < parts; ++part) {
        const size_t first = part * kMax, count = std::min(kMax, rays.size() - first);
        const Exclusions of_part = without.subspan(first, count);
        const RoutedRays some{rays.subspan(first, count), of_part,
                              hits.empty() ? hits : hits.subspan(first, count),
                              occluded.empty() ? occluded : occluded.subspan(first, count)};
        watch_.begin_part(part, parts);
        if (const Result<Done> done = run(some); !done)
            return done;
    }
    return watch_.unless_cancelled();
}

namespace {

/// Rays whose hit a filter has dropped, and which go on behind it.
struct GoingOn {
    std::vector<uint32_t> numbers; // in the call
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    std::vector<Hit> after;
    std::vector<uint32_t> masks;
    std::vector<Hit> hits;

    GoingOn(std::vector<uint32_t> numbers_, RaySpan all, const Exclusions& without,
            std::span<const Hit> dropped)
        : numbers(std::move(numbers_)), hits(numbers.size()) {
        for (const uint32_t i : numbers) {
            rays.push_back(all[i]);
            skip.push_back(without[i].skip);
            after.push_back(dropped[i]);
            masks.push_back(without.sieves[i].mask);
        }
    }

    Exclusions without() const {
        Exclusions all(skip, after);
        all.sieves.masks = masks;
        return all;
    }
};

} // namespace

/// Answers rays whose exclusions may have filters, which are asked here, at home.
Result<Done> RankedScene::nearest(RaySpan rays, const Exclusions& without, std::span<Hit> hits) {
    Exclusions plain = without;
    plain.sieves.filters = {};
    Result<Done> done = route(rays, plain, hits, {});
    if (!done || without.sieves.filters.empty())
        return done;
    std::vector<uint32_t> asked(rays.size());
    std::iota(asked.begin(), asked.end(), 0u);
    while (true) {
        auto further = dropped_hits(asked, without.sieves, hits);
        if (!further)
            return Error{"the filter stopped the call", ErrorKind::Cancelled};
        if (further->empty())
            return Done{};
        GoingOn some(std::move(*further), rays, without, hits);
        if (done = route(some.rays, some.without(), some.hits, {}); !done)
            return done;
        for (size_t i = 0; i < some.numbers.size(); ++i)
            hits[some.numbers[i]] = some.hits[i];
        asked = std::move(some.numbers);
    }
}

Result<Done> RankedScene::intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) {
    const Stopwatch watch;
    watch_.begin_call();
    const Result<Done> done = nearest(rays, without, hits);
    counted_.nearest_rays += rays.size();
    counted_.seconds_trace += watch.seconds();
    return done;
}

Result<Done> RankedScene::occluded(RaySpan rays, const Exclusions& without,
                                   std::span<uint8_t> occluded) {
    const Stopwatch watch;
    watch_.begin_call();
    counted_.occlusion_rays += rays.size();
    Result<Done> done = Done{};
    if (without.sieves.filters.empty()) {
        done = route(rays, without, {}, occluded);
    } else {
        std::vector<Hit> hits(rays.size());
        done = nearest(rays, without, hits);
        std::ranges::transform(hits, occluded.begin(), &Hit::is_hit);
    }
    counted_.seconds_trace += watch.seconds();
    return done;
}

Result<Done> RankedScene::all_hits(RaySpan rays, const Exclusions& without, const AllHits& all) {
    const Stopwatch watch;
    watch_.begin_call();
    counted_.nearest_rays += rays.size();
    std::ranges::fill(all.hits, Hit());
    std::ranges::fill(all.counts, 0u);
    if (all.has_enough(0))
        return Done{};
    std::vector<Hit> hits(rays.size());
    Result<Done> done = nearest(rays, without, hits);
    std::vector<uint32_t> numbers(rays.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    for (size_t n = 0; done; ++n) {
        std::vector<uint32_t> further;
        for (const uint32_t i : numbers)
            if (hits[i].is_hit()) {
                all.set(i, n, hits[i]);
                if (!all.has_enough(n + 1))
                    further.push_back(i);
            }
        if (further.empty())
            break;
        GoingOn some(std::move(further), rays, without, hits);
        Exclusions behind = some.without();
        std::vector<HitFilter*> filters;
        std::vector<uint64_t> names;
        for (const uint32_t i : some.numbers) {
            filters.push_back(without.sieves[i].filter);
            names.push_back(without.sieves[i].name);
        }
        if (!without.sieves.filters.empty())
            behind.sieves.filters = filters;
        behind.sieves.names = names;
        done = nearest(some.rays, behind, some.hits);
        for (size_t i = 0; i < some.numbers.size(); ++i)
            hits[some.numbers[i]] = some.hits[i];
        numbers = std::move(some.numbers);
    }
    counted_.seconds_trace += watch.seconds();
    return done;
}

Result<Done> RankedScene::stream(StreamHost& host) {
    const Stopwatch watch;
    watch_.begin_call();
    RoutedStream stream(routing_, routed_, host);
    const Result<Done> done = stream.run();
    counted_.nearest_rays += stream.nearest_rays();
    counted_.occlusion_rays += stream.occlusion_rays();
    counted_.seconds_trace += watch.seconds() - stream.seconds_host();
    return done;
}

void RankedScene::first_ranks(RaySpan rays, std::span<uint32_t> ranks) const {
    parallel_for(ranks.size(), 256, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            ranks[i] = parts_.finder->first_owner(rays[i]);
    });
}

Result<Done> RankedScene::purge() {
    // The server may be tracing for another rank.
    return server_.purge();
}

ovc_statistics RankedScene::report() const {
    ovc_statistics told = server_.report();
    told.rank = parts_.transport->rank();
    told.ranks = parts_.transport->ranks();
    told.nearest_rays = counted_.nearest_rays;
    told.occlusion_rays = counted_.occlusion_rays;
    told.seconds_trace = counted_.seconds_trace;
    told.rays_sent = routed_.visits_elsewhere;
    told.rays_served = server_.served();
    const TransportCounts transport = parts_.transport->counts();
    told.bytes_sent = transport.bytes_sent;
    told.bytes_received = transport.bytes_received;
    told.seconds_waiting = routed_.seconds_waiting;
    return told;
}

} // namespace ovc
