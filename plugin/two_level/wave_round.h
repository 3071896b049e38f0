// SPDX-License-Identifier: Apache-2.0
// WaveRound: runs passes over the rays that are ready in one wave, or in two that share the passes.
// As in OnePass, the rays are parted: beside the passes of some parts, the part before them is
// resolved and the next one is made ready.
#pragma once

#include "plugin/two_level/wave.h"

#include <algorithm>
#include <cassert>
#include <deque>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace ovc {

/// The pages that were moved beside passes. The rays of these passes may come to wait for them, so
/// they are called up until those rays are resolved.
class MovedBeside {
public:
    /// passes: how many steps later than it is sent a batch is resolved.
    explicit MovedBeside(size_t passes) : passes_(passes) {}

    /// Takes the pages that the step has moved, and calls up(pages) for each step whose rays were
    /// not resolved before this one.
    template <class CallUp>
    void call_up_after_step(std::vector<uint32_t> moved, CallUp&& up) {
        steps_.push_back(std::move(moved));
        drop_before(passes_ + 1);
        std::ranges::for_each(steps_, up);
    }
    /// The same once the last batch is resolved.
    template <class CallUp>
    void call_up_last(CallUp&& up) {
        drop_before(passes_);
        std::ranges::for_each(steps_, up);
    }

private:
    void drop_before(size_t steps) {
        while (steps_.size() > steps)
            steps_.pop_front();
    }

    size_t passes_;
    std::deque<std::vector<uint32_t>> steps_;
};

template <class... Queries>
class WaveRound {
public:
    WaveRound(const Tracing& tracing, PassRunner& passes, Wave<Queries>&... waves)
        : tracing_(tracing), passes_(passes), waves_(waves...) {}

    /// Runs passes over at most max_rays rays of all the waves. Pages that other rays wait for are
    /// moved in before the passes where few rays are ready, and beside them where few are left.
    /// meanwhile() -> bool runs beside each pass, until it returns false: no pass begins then.
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
        load(batch(0), std::min(passes_.part_rays(ready()), max_rays));
        std::deque<Batch*> under_way; // the first that was begun in front
        Batch* answered = nullptr;
        MovedBeside beside(passes_.passes_in_flight());
        bool goes_on = true;
        for (size_t step = 0; !under_way.empty() || !batch(step).rays.empty(); ++step) {
            Batch& now = batch(step);
            const bool begins = !now.rays.empty();
            std::vector<uint32_t> wanted_beside;
            if (begins) {
                assert(now.rays.size() <= max_rays);
                max_rays -= now.rays.size();
                if (passes_.moves_beside())
                    wanted_beside = wanted();
                passes_.begin_pass(now, wanted_beside);
                under_way.push_back(&now);
            }
            if (answered)
                resolve(*std::exchange(answered, nullptr));
            if (tracing_.scene.store)
                passes_.read_ahead(worth_moving());
            goes_on = goes_on && meanwhile();
            const bool enough = ready() >= passes_.few_rays();
            load(batch(step + 1),
                 goes_on && enough ? std::min(passes_.part_rays(ready()), max_rays) : 0);
            if (!begins || under_way.size() == passes_.passes_in_flight()) {
                answered = under_way.front();
                under_way.pop_front();
                if (const Result<Done> done = passes_.finish_pass(*answered); !done)
                    return done;
            }
            if (!wanted_beside.empty())
                wanted_beside.resize(passes_.moved_beside(now));
            beside.call_up_after_step(std::move(wanted_beside),
                                      [&](auto& moved) { call_up(moved); });
        }
        if (answered)
            resolve(*answered);
        beside.call_up_last([&](auto& moved) { call_up(moved); });
        return tracing_.watch.unless_cancelled();
    }

private:
    /// Batches take turns: while some are with the device, the answers of another are resolved and
    /// it is filled again.
    Batch& batch(size_t step) { return passes_.batches()[step % (passes_.passes_in_flight() + 1)]; }

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
