// SPDX-License-Identifier: Apache-2.0
// Wave: rays on their way through the leaves. Those in resident leaves are ready for the next pass,
// the others wait for theirs.
#pragma once

#include "plugin/settling.h"
#include "plugin/waiting.h"

#include <algorithm>
#include <utility>

namespace ovc {

/// The rays of a query, by their numbers in it.
template <class Query>
class TwoLevel::Wave : Settling<Query> {
    using Base = Settling<Query>;
    using Base::kGrain;
    using Base::query_;
    using Base::s_;

public:
    Wave(TwoLevel& structure, const Query& query)
        : Base(structure, query),
          positions_(query.rays.size()),
          waiting_(structure.scene_.level1.leaves.size()),
          used_(structure.scene_.level1.leaves.size()) {}

    /// The query's arrays have moved, or have more rays than before.
    void show(const Query& query) {
        query_ = query;
        positions_.resize(query.rays.size());
    }

    /// Puts these rays, none of them under way, at the beginning of theirs.
    void start(std::span<const uint32_t> rays) {
        parallel_for(rays.size(), kGrain, [&](size_t from, size_t to) {
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

    /// The leaves are resident now: who waited for them is ready.
    void call_up(std::span<const uint32_t> leaves) {
        for (const uint32_t leaf : leaves) {
            const std::vector<uint32_t> queue = waiting_.take(leaf);
            ready_.insert(ready_.end(), queue.begin(), queue.end());
            s_.statistics_.queues += !queue.empty();
            s_.statistics_.queued_rays += queue.size();
            s_.statistics_.longest_queue =
                std::max<uint64_t>(s_.statistics_.longest_queue, queue.size());
        }
    }

    /// Answers all rays that wait, in double.
    void answer_waiting() {
        std::vector<uint32_t> rays;
        for (uint32_t leaf = 0; leaf < s_.scene_.pages.size(); ++leaf) {
            const std::vector<uint32_t> queue = waiting_.take(leaf);
            rays.insert(rays.end(), queue.begin(), queue.end());
        }
        parallel_for(rays.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                this->answer_in_double(rays[j]);
        });
        s_.statistics_.stragglers += rays.size();
        finished_.insert(finished_.end(), rays.begin(), rays.end());
    }

    /// The rays that were answered since this was asked last.
    std::vector<uint32_t> take_finished() { return std::exchange(finished_, {}); }

    /// Puts rays that are ready into `travellers`, as many as there is room for, and their numbers
    /// into `rays`; returns how many. Beside a pass.
    size_t load(std::span<uint32_t> rays, std::span<Traveller> travellers) {
        const size_t count = std::min(ready_.size(), rays.size());
        std::copy_n(ready_.begin(), count, rays.begin());
        ready_.erase(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        loaded_ += count;
        parallel_for(count, kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const Position& at = positions_[rays[j]];
                travellers[j] = this->traveller(rays[j], at.t_from, at.t_end, at.leaf);
            }
        });
        return count;
    }

    /// Takes in the answers for rays that were loaded, and sends the rays on. Beside a pass.
    void settle(std::span<const uint32_t> rays, std::span<const Answer> answers) {
        parallel_for(rays.size(), kGrain, [&](size_t from, size_t to) {
            this->take_in(
                rays.subspan(from, to - from), answers.subspan(from, to - from),
                [&](uint32_t i, const Answer& answer) { return begins_to_settle(i, answer); },
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
                s_.tracer_->touch(leaf);
    }

private:
    /// Where a ray stands; t_from and leaf as in Traveller. Nothing beyond t_end is of interest.
    struct Position {
        double t_from = 0;
        double t_end = 0;
        uint32_t leaf = OVC_NO_LEAF;
        enum : uint32_t { Done, Ready, Waits } state = Done;
    };

    void start_one(uint32_t i) {
        positions_[i] = {};
        if (this->begins(i))
            positions_[i] = {query_.rays[i].t_min, query_.rays[i].t_max, OVC_NO_LEAF,
                             Position::Ready};
    }

    void send_on(std::span<const uint32_t> rays) {
        for (const uint32_t i : rays) {
            if (positions_[i].state == Position::Ready)
                ready_.push_back(i);
            else if (positions_[i].state == Position::Waits)
                waiting_.push(
                    s_.tracer_->has_links() ? leaf_of(positions_[i].leaf) : positions_[i].leaf, i);
            else
                finished_.push_back(i);
        }
    }

    /// Says in positions_[i] where the ray goes from here, as far as the answer alone tells. False:
    /// there is nothing in it to take in.
    bool begins_to_settle(uint32_t i, const Answer& answer) {
        Position& at = positions_[i];
        at.state = Position::Done;
        if (s_.tracer_->has_links()) {
            // The answer is that of all leaves before the one whose key it has, if any.
            if (answer.key() != OVC_NO_LEAF)
                at = {at.t_from, at.t_end, answer.key(), Position::Waits};
            if (answer.prim == OVC_MISS && answer.rivals()[0] == OVC_NO_TRIANGLE)
                return false;
            at.state = Position::Done;
            return true;
        }
        if (answer.prim == OVC_WAITS) {
            at = {answer.t(), at.t_end, answer.leaf(), Position::Waits};
            return false;
        }
        note_use(answer);
        return true;
    }

    /// The ray's best hit lies not beyond `end`, and later leaves may hold a nearer one. leaf: the
    /// one that it was found in, or under links the key of the next.
    bool goes_on(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        if (!s_.tracer_->has_links())
            return go_on_behind(i, leaf, p, end);
        positions_[i] = {positions_[i].t_from, end, leaf, Position::Waits};
        return true;
    }

    /// In certified precision an answer that names a triangle names the leaf it ended in.
    void note_use(const Answer& answer) {
        const bool names = answer.prim < OVC_MAX_TRIANGLES ||
                           (answer.prim == OVC_MISS && answer.rivals()[0] != OVC_NO_TRIANGLE);
        if (!s_.options_.certify || !names || answer.leaf() == OVC_NO_LEAF)
            return;
        std::atomic<uint8_t>& used = used_[answer.leaf()];
        if (used.load(std::memory_order_relaxed) == 0)
            used.store(1, std::memory_order_relaxed);
    }

    /// Sends the ray on unless its best hit, which is not beyond `end` however t is rounded, lies
    /// in the leaf's cell: then nothing of later cells is nearer, nor as near. False where rounding
    /// would send it back: t must grow, or two cells at a corner pass a ray to and fro.
    bool go_on_behind(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        const Box& cell = s_.scene_.level1.leaves[leaf].cell;
        // No rounding leads out of the cell.
        const Box safe = cell.padded(-(p.margin(cell) + cell.rounding()));
        const double exit = clip(p, cell, p.ray.t_min, p.ray.t_max).exit;
        if (end <= clip(p, safe, p.ray.t_min, p.ray.t_max).exit || exit >= end)
            return true;
        if (exit <= positions_[i].t_from)
            return false;
        positions_[i] = {exit, end, leaf + 1, Position::Ready};
        return true;
    }

    std::vector<Position> positions_; // per ray
    std::vector<uint32_t> ready_;     // rays for the next passes
    size_t loaded_ = 0;               // rays in batches
    std::vector<uint32_t> finished_;
    Waiting waiting_;
    std::vector<std::atomic<uint8_t>> used_; // per leaf: rays have ended there
};

template <class... Queries>
std::vector<uint32_t> TwoLevel::wanted_by(const Wave<Queries>&... waves) const {
    if ((waves.ready() + ...) >= few_rays() || (waves.waiting() + ...) == 0)
        return {};
    std::vector<size_t> counts(scene_.pages.size());
    for (uint32_t leaf = 0; leaf < counts.size(); ++leaf)
        counts[leaf] = (waves.queues().count(leaf) + ...);
    // Where active pages are told, each that a ray goes through is to be in the pool.
    return worth_moving(counts, scene_.pages, options_.tell_active ? ~uint64_t(0) : kBytesARay);
}

/// Fills the batch with rays that are ready.
template <class... Queries>
void TwoLevel::load(Batch& batch, size_t most, Wave<Queries>&... waves) {
    batch.rays.resize(std::min<size_t>((waves.ready() + ...), most));
    batch.make_room();
    size_t first = 0, k = 0;
    const auto one = [&](auto& wave) {
        const std::span rays = std::span(batch.rays).subspan(first);
        batch.of_waves[k] = wave.load(rays, std::span(batch.travellers).subspan(first));
        first += batch.of_waves[k++];
    };
    (one(waves), ...);
}

template <class... Queries>
void TwoLevel::settle(const Batch& batch, Wave<Queries>&... waves) {
    size_t first = 0, k = 0;
    const auto one = [&](auto& wave) {
        const size_t count = batch.of_waves[k++];
        wave.settle(std::span(batch.rays).subspan(first, count),
                    std::span(batch.answers).subspan(first, count));
        first += count;
    };
    (one(waves), ...);
}

/// As in OnePass, the rays are parted: beside the pass of one part, the part before is settled and
/// the next one made ready.
template <class Meanwhile, class... Queries>
Result<Done> TwoLevel::round(size_t most, Meanwhile&& meanwhile, Wave<Queries>&... waves) {
    // What is ready goes with the next pass, whose greater part then comes from the pages moved
    // in: so every pass gets somewhere, though those pages may push out what was ready for.
    const std::vector<uint32_t> before = wanted_by(waves...);
    const auto moved = std::span(before).first(before.empty() ? 0 : bring(before));
    (waves.call_up(moved), ...);
    if (before.empty() && (waves.ready() + ...) == 0) { // no queue is worth its page
        (waves.answer_waiting(), ...);
        return Done{};
    }
    if ((waves.ready() + ...) == 0)
        return lost(); // nothing could be moved in
    const size_t ready = (waves.ready() + ...);
    Batch* now = &batches_[0];
    Batch* other = &batches_[1];
    load(*other, 0, waves...);
    load(*now, std::min(part_rays(ready), most), waves...);
    std::vector<uint32_t> beside; // pages moved in beside the pass: its rays may wait for them
    bool goes_on = true;
    while (!now->rays.empty()) {
        most -= now->rays.size();
        std::vector<uint32_t> wanted;
        if (options_.beside.value_or(!gl_.info().is_software))
            wanted = wanted_by(waves...);
        const Result<size_t> moved_beside = pass(*now, wanted, [&] {
            settle(*other, waves...);
            goes_on = meanwhile() && goes_on;
            const bool enough = (waves.ready() + ...) >= few_rays();
            load(*other, goes_on && enough ? std::min(part_rays(ready), most) : 0, waves...);
        });
        if (!moved_beside)
            return moved_beside.error();
        wanted.resize(*moved_beside);
        (waves.tell_used(), ...);
        (waves.call_up(beside), ...);
        (waves.call_up(wanted), ...);
        beside = std::move(wanted);
        std::swap(now, other);
    }
    settle(*other, waves...);
    (waves.tell_used(), ...);
    (waves.call_up(beside), ...);
    return Done{};
}

} // namespace ovc
