// SPDX-License-Identifier: Apache-2.0
// Wave: the rays of a query that are on their way. Those that need no other page yet are ready for
// the next pass, the others wait for theirs.
#pragma once

#include "plugin/resolve/resolve.h"
#include "plugin/resolve/sifting.h"
#include "plugin/two_level/pass_runner.h"
#include "plugin/two_level/waiting.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {

/// Rays go by their numbers in the query.
template <class Query>
class Wave {
public:
    static constexpr bool kAnyHit = Query::kAnyHit;

    Wave(const Tracing& tracing, PassRunner& passes, const Query& query)
        : tracing_(tracing),
          passes_(passes),
          resolver_(tracing, query, /* are_whole= */ false),
          states_(query.rays.size()),
          passed_by_(query.has_sieves() ? query.rays.size() : 0),
          waiting_(tracing.scene.pages.size()) {}

    /// Replaces the query where its arrays have moved or have more rays than before.
    void show(const Query& query) {
        resolver_.show(query);
        states_.resize(query.rays.size());
        passed_by_.resize(query.has_sieves() ? query.rays.size() : 0);
    }

    /// Starts these rays, none of which is under way.
    void start(std::span<const uint32_t> rays) {
        parallel_for(rays.size(), kRaysPerTask,
                     [&](size_t from, size_t to) { start_some(rays.subspan(from, to - from)); });
        if (resolver_.query().has_sieves())
            for (const uint32_t i : rays)
                passed_by_[i] = 0;
        send_on(rays);
    }

    /// Returns how many rays are under way and not answered yet.
    size_t left() const { return ready() + waiting() + loaded_; }
    size_t ready() const { return ready_.size(); }
    size_t waiting() const { return waiting_.count(); }
    const Waiting& queues() const { return waiting_; }

    /// Makes the rays ready that waited for these leaves, which are resident now.
    void call_up(std::span<const uint32_t> leaves) {
        for (const uint32_t leaf : leaves) {
            const std::vector<uint32_t> queue = waiting_.take(leaf);
            ready_.insert(ready_.end(), queue.begin(), queue.end());
            ovc_statistics& statistics = tracing_.statistics;
            statistics.queues += !queue.empty();
            statistics.queued_rays += queue.size();
            statistics.longest_queue = std::max<uint64_t>(statistics.longest_queue, queue.size());
        }
    }

    /// Answers all rays that wait by the exact fallback.
    void answer_waiting() {
        std::vector<uint32_t> rays;
        for (uint32_t leaf = 0; leaf < tracing_.scene.pages.size(); ++leaf) {
            const std::vector<uint32_t> queue = waiting_.take(leaf);
            rays.insert(rays.end(), queue.begin(), queue.end());
        }
        answer(rays);
    }

    /// Answers all rays that are ready, and those that go on behind their hits, by the exact
    /// fallback, where these are the last few: a ray may have to pass by many hits, and each of
    /// them would cost a pass.
    void answer_last_few() {
        constexpr size_t kFew = 64; // they take about as long as a pass of a few rays
        while (ready() > 0 && ready() <= kFew && waiting() == 0 && loaded_ == 0)
            answer(std::exchange(ready_, {}));
    }

    /// Returns the rays that were answered since the last call of this.
    std::vector<uint32_t> take_finished() { return std::exchange(finished_, {}); }

    /// Puts rays that are ready into `sent` from the place `first` on, as many as there is room
    /// for, and their numbers into `rays`; returns how many. May run beside a pass.
    size_t load(std::span<uint32_t> rays, SentRays& sent, size_t first) {
        assert(sent.size() >= first + rays.size());
        const size_t count = std::min(ready_.size(), rays.size());
        std::copy_n(ready_.begin(), count, rays.begin());
        ready_.erase(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        loaded_ += count;
        parallel_for(count, kRaysPerTask, [&](size_t from, size_t to) {
            resolver_.in_lanes(rays.subspan(from, to - from), [&](RayStates& states, auto some,
                                                                  size_t j) {
                for (size_t lane = 0; lane < some.size(); ++lane) {
                    const State& at = states_[some[lane]];
                    double& t_max = states.rays.t_max[lane];
                    t_max = std::min(t_max, at.t_end);
                    states.asks[lane] |= at.key;
                }
                resolver_.send(sent, first + from + j, states, some, RayLanes::first(some.size()));
            });
        });
        return count;
    }

    /// Resolves the answers from the `first` on, one per ray, for rays that were loaded, and sends
    /// the rays on. May run beside a pass.
    void resolve(std::span<const uint32_t> rays, const Answers& answers, size_t first) {
        assert(rays.size() <= loaded_);
        parallel_for(rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            resolver_.resolve(
                rays.subspan(from, to - from), answers, first + from,
                [&](uint32_t i, const Answer& answer) { return takes(i, answer); },
                [&](uint32_t i, uint32_t key, double end) {
                    states_[i] = {end, key, State::Waits};
                });
        });
        loaded_ -= rays.size();
        send_on(rays);
    }

private:
    /// How far a ray has come. It goes on at the resume key, and hits beyond t_end are of no
    /// interest.
    struct State {
        double t_end = 0;
        uint32_t key = 0;
        enum : uint32_t { Done, Ready, Waits } stage = Done;
    };

    void answer(std::span<const uint32_t> rays) {
        constexpr size_t kGrain = 8; // such a ray takes long
        parallel_for(rays.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                resolver_.answer_exactly(rays[j]);
        });
        tracing_.statistics.stragglers += rays.size();
        for (const uint32_t i : rays)
            states_[i].stage = State::Done;
        send_on(rays);
    }

    void start_some(std::span<const uint32_t> rays) {
        resolver_.in_lanes(rays, [&](RayStates& states, std::span<const uint32_t> some, size_t) {
            const uint32_t begins = resolver_.begins(states, some);
            for (size_t lane = 0; lane < some.size(); ++lane)
                states_[some[lane]] =
                    begins >> lane & 1 ? State{states.rays.t_max[lane], 0, State::Ready} : State{};
        });
    }

    void send_on(std::span<const uint32_t> rays) {
        if (resolver_.query().has_sieves())
            parallel_for(rays.size(), kRaysPerTask,
                         [&](size_t from, size_t to) { sift(rays.subspan(from, to - from)); });
        for (const uint32_t i : rays) {
            if (states_[i].stage == State::Ready)
                ready_.push_back(i);
            else if (states_[i].stage == State::Waits)
                waiting_.push(leaf_of(states_[i].key), i);
            else
                finished_.push_back(i);
        }
    }

    /// Starts those of the rays anew whose hit does not count, behind that hit; answers those for
    /// good that have passed by many.
    void sift(std::span<const uint32_t> rays) {
        std::vector<uint32_t> answered(rays.begin(), rays.end());
        std::vector<Hit> hits;
        for (;;) {
            std::erase_if(answered, [&](uint32_t i) {
                return states_[i].stage != State::Done || !resolver_.query().was_hit(i);
            });
            if (answered.empty())
                return;
            hits.clear();
            for (const uint32_t i : answered)
                hits.push_back(resolver_.query().hit(i));
            const std::vector<uint8_t> counts = counting_hits(
                tracing_.scene.soup, resolver_.query().without.sieves, answered, hits);
            std::vector<uint32_t> left;
            size_t passed_by = 0;
            for (size_t j = 0; j < answered.size(); ++j) {
                const uint32_t i = answered[j];
                if (counts[j])
                    continue;
                resolver_.query().pass_by(i);
                // Where active pages are told, rays go through them on the GPU.
                if (++passed_by_[i] >= kMaxPassedBy && !tracing_.options.tell_active) {
                    left.push_back(i);
                    continue;
                }
                start_some(std::span(&i, 1)); // the exact fallback may answer it
                answered[passed_by++] = i;
            }
            answered.resize(passed_by);
            parallel_for(left.size(), 1, [&](size_t from, size_t to) {
                for (size_t j = from; j < to; ++j)
                    resolver_.answer_sifted(left[j]);
            });
        }
    }

    /// Sets in states_[i] where the ray goes from here, as far as the answer alone tells. Returns
    /// false where it has nothing to resolve.
    bool takes(uint32_t i, const Answer& answer) {
        State& at = states_[i];
        at.stage = State::Done;
        if (!candidates_of(answer).is_miss())
            return true;
        // The answer is that of all pages before the one whose key it has, if any.
        if (answer.where != OVC_NO_LEAF)
            at = {at.t_end, answer.where, State::Waits};
        return false;
    }

    const Tracing tracing_;
    PassRunner& passes_;
    Resolver<Query> resolver_;
    std::vector<State> states_;      // per ray
    std::vector<uint8_t> passed_by_; // hits of each ray, where rays have sieves
    std::vector<uint32_t> ready_;    // rays for the next passes
    size_t loaded_ = 0;              // rays in batches
    std::vector<uint32_t> finished_;
    Waiting waiting_;
};

} // namespace ovc
