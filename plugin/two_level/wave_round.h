// SPDX-License-Identifier: Apache-2.0
// WaveRound: runs passes over the rays that are ready in one wave, or in two that share the passes.
// As in OnePass, the rays are parted: beside the pass of one part, the part before is resolved and
// the next one is made ready.
#pragma once

#include "plugin/two_level/wave.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace ovc {

template <class... Queries>
class WaveRound {
public:
    WaveRound(const Tracing& tracing, PassRunner& passes, Wave<Queries>&... waves)
        : tracing_(tracing), passes_(passes), waves_(waves...) {}

    /// Runs passes over at most max_rays rays of all the waves. Pages that other rays wait for are
    /// moved in before the passes where few rays are ready, and beside them where few are left.
    /// meanwhile() -> bool runs beside each pass, and returns false to make it the last one.
    template <class Meanwhile>
    Result<Done> run(size_t max_rays, Meanwhile&& meanwhile) {
        // Rays that are ready join the next pass, most of which then consists of rays that waited
        // for the pages moved in. So every pass gets somewhere, though those pages may push out the
        // ones that the others were ready for.
        const std::vector<uint32_t> before = wanted();
        passes_.read_ahead(before);
        call_up(std::span(before).first(before.empty() ? 0 : passes_.bring(before)));
        if (before.empty() && ready() == 0) { // no queue is worth its page
            each([](auto& wave) { wave.answer_waiting(); });
            return Done{};
        }
        if (const Result<Done> fine = tracing_.watch.unless_cancelled(); !fine)
            return fine;
        if (ready() == 0)
            return passes_.lost(); // nothing could be moved in
        const PassRunner::Scope scope(passes_);
        Batch* now = &passes_.batches()[0];
        Batch* other = &passes_.batches()[1];
        load(*other, 0);
        load(*now, std::min(passes_.part_rays(ready()), max_rays));
        std::vector<uint32_t> beside; // pages moved in beside the pass: its rays may wait for them
        bool goes_on = true;
        while (!now->rays.empty()) {
            assert(now->rays.size() <= max_rays);
            max_rays -= now->rays.size();
            std::vector<uint32_t> wanted_beside;
            if (passes_.moves_beside())
                wanted_beside = wanted();
            passes_.begin_pass(*now, wanted_beside);
            resolve(*other);
            if (tracing_.scene.store)
                passes_.read_ahead(worth_moving());
            goes_on = meanwhile() && goes_on;
            const bool enough = ready() >= passes_.few_rays();
            load(*other, goes_on && enough ? std::min(passes_.part_rays(ready()), max_rays) : 0);
            const Result<size_t> moved = passes_.finish_pass(*now);
            if (!moved)
                return moved.error();
            assert(*moved <= wanted_beside.size());
            wanted_beside.resize(*moved);
            call_up(beside);
            call_up(wanted_beside);
            beside = std::move(wanted_beside);
            std::swap(now, other);
        }
        resolve(*other);
        call_up(beside);
        return tracing_.watch.unless_cancelled();
    }

private:
    template <class Body>
    void each(Body&& body) {
        std::apply([&](auto&... wave) { (body(wave), ...); }, waves_);
    }
    size_t ready() {
        return std::apply([](auto&... wave) { return (wave.ready() + ...); }, waves_);
    }
    size_t waiting() {
        return std::apply([](auto&... wave) { return (wave.waiting() + ...); }, waves_);
    }
    void call_up(std::span<const uint32_t> leaves) {
        each([&](auto& wave) { wave.call_up(leaves); });
    }

    /// Returns the leaves worth moving in for rays of these waves where few are ready; else none.
    std::vector<uint32_t> wanted() {
        return ready() >= passes_.few_rays() || waiting() == 0 ? std::vector<uint32_t>()
                                                               : worth_moving();
    }

    std::vector<uint32_t> worth_moving() {
        std::vector<size_t> counts(tracing_.scene.pages.size());
        each([&](auto& wave) {
            for (uint32_t leaf = 0; leaf < counts.size(); ++leaf)
                counts[leaf] += wave.queues().count(leaf);
        });
        // Where active pages are told, each page that a ray goes through must be in the pool. On a
        // disk a page must be read whoever answers its rays.
        const bool all = tracing_.options.tell_active || tracing_.scene.store;
        return ovc::worth_moving(counts, passes_.costs(), all ? ~uint64_t(0) : kBytesARay);
    }

    /// Fills the batch with rays that are ready.
    void load(Batch& batch, size_t max_rays) {
        batch.rays.resize(std::min(ready(), max_rays));
        batch.make_room(passes_.form());
        size_t first = 0, k = 0;
        bool all_any_hit = true;
        each([&](auto& wave) {
            const size_t count = wave.load(std::span(batch.rays).subspan(first), batch.sent, first);
            batch.of_waves[k++] = count;
            first += count;
            all_any_hit = all_any_hit && (count == 0 || wave.kAnyHit);
        });
        batch.sent.set_all_any_hit(all_any_hit);
        assert(first == batch.rays.size());
    }

    void resolve(const Batch& batch) {
        size_t first = 0, k = 0;
        each([&](auto& wave) {
            const size_t count = batch.of_waves[k++];
            wave.resolve(std::span(batch.rays).subspan(first, count), batch.answers, first);
            first += count;
        });
    }

    const Tracing tracing_;
    PassRunner& passes_;
    std::tuple<Wave<Queries>&...> waves_;
};

/// Answers the query in waves of as many rays as a call may hold in host memory at once.
template <class Query>
Result<Done> trace_in_waves(const Tracing& tracing, PassRunner& passes, const Query& query) {
    constexpr size_t kWaveRays = 4u << 20;
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        Wave<Query> wave(tracing, passes, query.part(first, count));
        std::vector<uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        wave.start(all);
        while (wave.left() > 0) {
            Result<Done> asked = Done{};
            const auto ask = [&] {
                asked = tracing.watch.go_on(first + count - wave.left(), query.rays.size());
                return bool(asked);
            };
            if (Result<Done> done = WaveRound(tracing, passes, wave).run(~size_t(0), ask); !done)
                return done;
            if (!asked)
                return asked;
            if (query.has_sieves() && !tracing.options.tell_active)
                wave.answer_last_few();
        }
    }
    return Done{};
}

} // namespace ovc
