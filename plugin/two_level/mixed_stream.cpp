// SPDX-License-Identifier: Apache-2.0
// The mixed form over two-level: rays of both kinds are under way together, and what the host
// spawns joins them before pages are moved. Based on: thesis, section 3.5 (algorithm 6).
#include "plugin/two_level/mixed_stream.h"

#include "core/stream/backlog.h"
#include "core/system/stopwatch.h"
#include "plugin/two_level/wave_round.h"

#include <cassert>

namespace ovc {
namespace {

/// The rays of one kind in a stream. A ray has a slot from its start until its answer is handed
/// over.
template <class Query>
class Lane {
    using Result = std::remove_reference_t<decltype(Query{}.results[0])>;

public:
    Lane(const Tracing& tracing, PassRunner& passes) : wave_(tracing, passes, Query{}) {}

    Wave<Query>& wave() { return wave_; }
    void push(const StreamRays& rays) { backlog_.push(rays); }
    size_t backlog() const { return backlog_.size(); }
    size_t under_way() const { return rays_.size() - free_.size(); }
    bool empty() const { return backlog() + under_way() == 0; }
    bool can_start() const { return backlog() > 0 && under_way() < kSlots; }

    /// Starts rays of the backlog, as many as there may be at once; returns how many.
    size_t start() {
        const size_t count = std::min(backlog_.size(), kSlots - under_way());
        if (count == 0)
            return 0;
        grow(under_way() + count);
        assert(free_.size() >= count);
        const StreamRays rays = backlog_.last(count);
        if (!rays.are_plain() && places_.empty())
            make_room_for_exclusions();
        const std::vector<uint32_t> slots(free_.end() - ptrdiff_t(count), free_.end());
        free_.resize(free_.size() - count);
        parallel_for(count, kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                rays_[slots[i]] = rays.rays[i];
                skip_[slots[i]] = rays.skip[i];
                tokens_[slots[i]] = rays.tokens[i];
                if (!places_.empty())
                    exclude(slots[i], rays, i);
            }
        });
        backlog_.drop_last(count);
        wave_.start(slots);
        return count;
    }

    /// Hands the answers to hand_over(tokens, results), if there are any. Returns false where that
    /// does.
    template <class HandOver>
    bool deliver(HandOver&& hand_over) {
        const std::vector<uint32_t> finished = wave_.take_finished();
        if (finished.empty())
            return true;
        std::vector<uint64_t> tokens(finished.size());
        std::vector<Result> results(finished.size());
        parallel_for(finished.size(), kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                tokens[i] = tokens_[finished[i]];
                results[i] = results_[finished[i]];
            }
        });
        free_.insert(free_.end(), finished.begin(), finished.end());
        return hand_over(tokens, results);
    }

    static constexpr size_t kSlots = size_t(1) << 20; // some 150 bytes each

private:
    static constexpr size_t kGrain = 1024; // rays a task, which only copies them

    /// Makes at least `slots` slots, and twice as many as before where it makes any.
    void grow(size_t slots) {
        assert(slots <= kSlots);
        const size_t before = rays_.size();
        if (slots <= before)
            return;
        const size_t now = std::min(std::max(slots, 2 * before), kSlots);
        rays_.resize(now);
        skip_.resize(now);
        tokens_.resize(now);
        results_.resize(now);
        for (size_t slot = now; slot-- > before;)
            free_.push_back(uint32_t(slot));
        if (!places_.empty())
            make_room_for_exclusions();
        show();
    }

    /// Gives each slot a place, a mask and a filter, from the first ray on that has one of them.
    void make_room_for_exclusions() {
        places_.resize(rays_.size(), kBeforeAll);
        masks_.resize(rays_.size());
        filters_.resize(rays_.size());
        show();
    }

    void exclude(uint32_t slot, const StreamRays& rays, size_t i) {
        places_[slot] = rays.after.empty() ? kBeforeAll : rays.after[i];
        masks_[slot] = rays.masks.empty() ? 0 : rays.masks[i];
        filters_[slot] = rays.filters.empty() ? nullptr : rays.filters[i];
    }

    void show() {
        Query query{};
        query.rays = rays_;
        query.without = {skip_, places_};
        query.without.sieves = {masks_, filters_, tokens_};
        query.results = results_;
        query.may_pass_by(places_);
        wave_.show(query);
    }

    Backlog backlog_;
    std::vector<Ray> rays_; // per slot, as the next three
    std::vector<TriangleId> skip_;
    std::vector<uint64_t> tokens_;
    std::vector<Result> results_;
    // Per slot, or empty as long as there were only plain rays.
    std::vector<Hit> places_;
    std::vector<uint32_t> masks_;
    std::vector<HitFilter*> filters_;
    std::vector<uint32_t> free_;
    Wave<Query> wave_;
};

class MixedStream final : public RayStream {
public:
    MixedStream(const Tracing& tracing, PassRunner& passes, StreamHost& host)
        : statistics_(tracing.statistics),
          host_(host),
          nearest_(tracing, passes),
          any_(tracing, passes),
          sieved_any_(tracing, passes),
          round_(tracing, passes, any_.wave(), sieved_any_.wave(), nearest_.wave()) {}

    void push(const StreamRays& rays) override {
        if (!rays.any_hit)
            nearest_.push(rays);
        else if (rays.are_plain())
            any_.push(rays);
        else
            sieved_any_.push(rays);
    }

    /// The host gets the answers of a pass while the next one runs. Where pages are to be moved
    /// before the next one, the host gets them first, so that the rays that it spawns join that
    /// pass.
    ovc::Result<Done> run() {
        bool goes_on = true;
        while (goes_on && fill()) {
            start();
            if (nearest_.empty() && any_.empty() && sieved_any_.empty())
                return Done{};
            const size_t ready = sum([](auto& lane) { return lane.wave().ready(); });
            const bool beside = sum([](auto& lane) { return lane.wave().waiting(); }) == 0;
            if (ready == 0 || !beside) {
                goes_on = deliver();
                if (!goes_on || sum([](auto& lane) { return lane.can_start(); }) > 0)
                    continue;
            }
            if (ready == 0 && beside)
                continue;
            const Stopwatch watch;
            const ovc::Result<Done> done = round_.run(beside ? kPassRays : ~size_t(0), [&] {
                goes_on = !beside || deliver();
                return goes_on;
            });
            statistics_.seconds_trace += watch.seconds();
            if (!done)
                return done;
        }
        return stopped_by_host();
    }

private:
    /// Returns the sum of what count(lane) returns of all lanes.
    template <class Count>
    size_t sum(Count&& count) {
        return size_t(count(nearest_)) + size_t(count(any_)) + size_t(count(sieved_any_));
    }

    /// Asks the host for more rays where fewer than half of the slots are taken. Returns false
    /// where the host stops the stream.
    bool fill() {
        const size_t under_way = nearest_.under_way() + nearest_.backlog();
        if (!more_ || under_way > Lane<NearestQuery>::kSlots / 2)
            return true;
        const auto backlog = [&] { return sum([](auto& lane) { return lane.backlog(); }); };
        const size_t before = backlog();
        if (!host_.more(*this, Lane<NearestQuery>::kSlots - under_way))
            return false;
        more_ = backlog() > before;
        return true;
    }

    void start() {
        const Stopwatch watch;
        const size_t nearest = nearest_.start();
        const size_t any = any_.start() + sieved_any_.start();
        statistics_.nearest_rays += nearest;
        statistics_.occlusion_rays += any;
        statistics_.seconds_trace += watch.seconds();
    }

    /// Rays a pass where no page need be moved: enough to keep a device busy, and few enough that
    /// passes and the host's work on their answers go on beside each other.
    static constexpr size_t kPassRays = size_t(1) << 17;

    bool deliver() {
        const auto occlusions = [&](std::span<const uint64_t> tokens,
                                    std::span<const uint8_t> occluded) {
            return host_.occlusions(*this, tokens, occluded);
        };
        const auto as_occlusions = [&](std::span<const uint64_t> tokens,
                                       std::span<const Hit> hits) {
            std::vector<uint8_t> occluded(hits.size());
            std::ranges::transform(hits, occluded.begin(), &Hit::is_hit);
            return occlusions(tokens, occluded);
        };
        return any_.deliver(occlusions) && sieved_any_.deliver(as_occlusions) &&
               nearest_.deliver([&](std::span<const uint64_t> tokens, std::span<const Hit> hits) {
                   return host_.hits(*this, tokens, hits);
               });
    }

    ovc_statistics& statistics_;
    StreamHost& host_;
    Lane<NearestQuery> nearest_;
    Lane<OcclusionQuery> any_;
    Lane<NearestQuery> sieved_any_; // occlusion of rays that are not plain: any hit may not count
    WaveRound<OcclusionQuery, NearestQuery, NearestQuery> round_;
    bool more_ = true;
};

} // namespace

Result<Done> trace_stream(const Tracing& tracing, PassRunner& passes, StreamHost& host) {
    return MixedStream(tracing, passes, host).run();
}

} // namespace ovc
