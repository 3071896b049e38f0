// SPDX-License-Identifier: Apache-2.0
// Wave: rays on their way through the leaves. Those in resident leaves are ready for the next pass,
// the others wait for theirs.
#pragma once

#include "plugin/pass_runner.h"
#include "plugin/resolve.h"
#include "plugin/waiting.h"

#include <algorithm>
#include <utility>

namespace ovc {

/// The rays of a query, by their numbers in it.
template <class Query>
class Wave {
public:
    Wave(const Tracing& tracing, PassRunner& passes, const Query& query)
        : tracing_(tracing),
          passes_(passes),
          resolver_(tracing, query),
          states_(query.rays.size()),
          waiting_(tracing.scene.level1.leaves.size()),
          used_(tracing.scene.level1.leaves.size()) {}

    /// The query's arrays have moved, or have more rays than before.
    void show(const Query& query) {
        resolver_.show(query);
        states_.resize(query.rays.size());
    }

    /// Puts these rays, none of them under way, at the beginning of theirs.
    void start(std::span<const uint32_t> rays) {
        parallel_for(rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                start_one(rays[j]);
        });
        send_on(rays);
    }

    /// Rays that are not answered yet.
    size_t left() const { return ready() + waiting() + loaded_; }
    size_t ready() const { return ready_.size(); }
    size_t waiting() const { return waiting_.count(); }
    const Waiting& queues() const { return waiting_; }

    /// The leaves are resident now, so that the rays that waited for them are ready.
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
        parallel_for(rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                resolver_.answer_exactly(rays[j]);
        });
        tracing_.statistics.stragglers += rays.size();
        finished_.insert(finished_.end(), rays.begin(), rays.end());
    }

    /// The rays that were answered since this was asked last.
    std::vector<uint32_t> take_finished() { return std::exchange(finished_, {}); }

    /// Puts rays that are ready into `states`, as many as there is room for, and their numbers into
    /// `rays`; returns how many. Beside a pass.
    size_t load(std::span<uint32_t> rays, std::span<Traveller> states) {
        const size_t count = std::min(ready_.size(), rays.size());
        std::copy_n(ready_.begin(), count, rays.begin());
        ready_.erase(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        loaded_ += count;
        parallel_for(count, kRaysPerTask, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const State& at = states_[rays[j]];
                states[j] = resolver_.ray_state(rays[j], at.t_from, at.t_end, at.leaf);
            }
        });
        return count;
    }

    /// Resolves the answers for rays that were loaded, and sends the rays on. Beside a pass.
    void resolve(std::span<const uint32_t> rays, std::span<const Answer> answers) {
        parallel_for(rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            resolver_.resolve(
                rays.subspan(from, to - from), answers.subspan(from, to - from),
                [&](uint32_t i, const Answer& answer) { return takes(i, answer); },
                [&](uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
                    return goes_on(i, leaf, p, end);
                });
        });
        loaded_ -= rays.size();
        send_on(rays);
    }

    /// Tells the pool in which leaves rays have ended.
    void tell_used() {
        for (uint32_t leaf = 0; leaf < used_.size(); ++leaf)
            if (used_[leaf].exchange(0, std::memory_order_relaxed))
                passes_.touch(leaf);
    }

private:
    /// How far a ray has come; t_from and leaf as in Traveller. Nothing beyond t_end is of
    /// interest.
    struct State {
        double t_from = 0;
        double t_end = 0;
        uint32_t leaf = OVC_NO_LEAF;
        enum : uint32_t { Done, Ready, Waits } stage = Done;
    };

    void start_one(uint32_t i) {
        states_[i] = {};
        const Ray& ray = resolver_.query().rays[i];
        if (resolver_.begins(i))
            states_[i] = {ray.t_min, ray.t_max, OVC_NO_LEAF, State::Ready};
    }

    void send_on(std::span<const uint32_t> rays) {
        for (const uint32_t i : rays) {
            if (states_[i].stage == State::Ready)
                ready_.push_back(i);
            else if (states_[i].stage == State::Waits)
                waiting_.push(passes_.has_tree() ? leaf_of(states_[i].leaf) : states_[i].leaf, i);
            else
                finished_.push_back(i);
        }
    }

    /// Says in states_[i] where the ray goes from here, as far as the answer alone tells. False:
    /// there is nothing in it to resolve.
    bool takes(uint32_t i, const Answer& answer) {
        State& at = states_[i];
        at.stage = State::Done;
        if (passes_.has_tree()) {
            // The answer is that of all leaves before the one whose key it has, if any.
            if (answer.where != OVC_NO_LEAF)
                at = {at.t_from, at.t_end, answer.where, State::Waits};
            if (candidates_of(answer).is_miss())
                return false;
            at.stage = State::Done;
            return true;
        }
        if (answer.prim == OVC_WAITS) {
            at = {answer.t(), at.t_end, answer.where, State::Waits};
            return false;
        }
        note_use(answer);
        return true;
    }

    /// The ray's best hit lies not beyond `end`, and later leaves may hold a nearer one. leaf: the
    /// one that it was found in, or under the top-level tree the key of the next.
    bool goes_on(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        if (!passes_.has_tree())
            return go_on_behind(i, leaf, p, end);
        states_[i] = {states_[i].t_from, end, leaf, State::Waits};
        return true;
    }

    /// In certified precision an answer that names a triangle names the leaf it ended in.
    void note_use(const Answer& answer) {
        const bool names = answer.prim < OVC_MAX_TRIANGLES ||
                           (answer.prim == OVC_MISS && candidates_of(answer).has_further());
        if (!tracing_.options.certify || !names || answer.where == OVC_NO_LEAF)
            return;
        std::atomic<uint8_t>& used = used_[answer.where];
        if (used.load(std::memory_order_relaxed) == 0)
            used.store(1, std::memory_order_relaxed);
    }

    /// Sends the ray on unless its best hit, which is not beyond `end` however t is rounded, lies
    /// in the leaf's cell: then nothing of later cells is nearer, nor as near. False where rounding
    /// would send it back: t must grow, or two cells at a corner pass a ray to and fro.
    bool go_on_behind(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        const Box& cell = tracing_.scene.level1.leaves[leaf].cell;
        // No rounding leads out of the cell.
        const Box safe = cell.padded(-(p.margin(cell) + cell.rounding()));
        const double exit = clip(p, cell, p.ray.t_min, p.ray.t_max).exit;
        if (end <= clip(p, safe, p.ray.t_min, p.ray.t_max).exit || exit >= end)
            return true;
        if (exit <= states_[i].t_from)
            return false;
        states_[i] = {exit, end, leaf + 1, State::Ready};
        return true;
    }

    const Tracing tracing_;
    PassRunner& passes_;
    Resolver<Query> resolver_;
    std::vector<State> states_;   // per ray
    std::vector<uint32_t> ready_; // rays for the next passes
    size_t loaded_ = 0;           // rays in batches
    std::vector<uint32_t> finished_;
    Waiting waiting_;
    std::vector<std::atomic<uint8_t>> used_; // per leaf: rays have ended there
};

} // namespace ovc
