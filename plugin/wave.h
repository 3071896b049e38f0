// SPDX-License-Identifier: Apache-2.0
// Wave: rays on their way through the leaves. Those in resident leaves are ready for the next pass,
// the others wait for theirs.
#pragma once

#include "core/parallel.h"
#include "kdtree/restart.h"
#include "plugin/arbiter.h"
#include "plugin/query.h"
#include "plugin/two_level.h"
#include "plugin/waiting.h"
#include "shaders/layout.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>

namespace ovc {

/// The rays of a query, by their numbers in it.
template <class Query>
class TwoLevel::Wave {
    static constexpr size_t kGrain = 256; // rays a task

public:
    Wave(TwoLevel& structure, const Query& query)
        : s_(structure),
          waiting_(structure.level1_.leaves.size()),
          used_(structure.level1_.leaves.size()) {
        show(query);
    }
    ~Wave() {
        s_.statistics_.invalid_rays += invalid_;
        s_.statistics_.flagged += flagged_;
        s_.statistics_.retraced += retraced_;
        s_.statistics_.capped += capped_;
    }
    Wave(const Wave&) = delete;

    /// The query's arrays have moved, or have more rays than before.
    void show(const Query& query) {
        query_ = query;
        positions_.resize(query.rays.size());
    }

    /// Puts these rays, none of them under way, at the beginning of theirs.
    void start(std::span<const uint32_t> rays) {
        const Box scene = s_.level1_.bounds.padded(s_.level1_.padding); // empty: no triangles
        parallel_for(rays.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                start_one(rays[j], scene);
        });
        send_on(rays);
    }

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

    /// The rays that were answered since this was asked last.
    std::vector<uint32_t> take_finished() { return std::exchange(finished_, {}); }

    /// Puts rays that are ready into `travellers`, as many as there is room for; returns how many.
    size_t load(std::span<Traveller> travellers) {
        const size_t count = std::min(ready_.size(), travellers.size());
        batch_.assign(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        ready_.erase(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        parallel_for(count, kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const Position& at = positions_[batch_[j]];
                query_.count_pass(batch_[j]);
                Ray rest = query_.rays[batch_[j]];
                rest.t_max = at.t_end;
                travellers[j] = {rest, at.t_from, s_.number_to_skip(query_.skipped(batch_[j])),
                                 at.leaf | (Query::kAnyHit ? OVC_RAY_ANY_HIT : 0)};
            }
        });
        return count;
    }

    /// Takes in the answers for what was loaded last, and sends the rays on.
    void settle(std::span<const Answer> answers) {
        parallel_for(answers.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                settle_one(batch_[j], answers[j]);
        });
        for (uint32_t leaf = 0; leaf < used_.size(); ++leaf)
            if (used_[leaf].exchange(0, std::memory_order_relaxed))
                s_.tracer_->touch(leaf);
        send_on(batch_);
    }

private:
    /// Where a ray stands; t_from and leaf as in Traveller. Nothing beyond t_end is of interest.
    struct Position {
        double t_from = 0;
        double t_end = 0;
        uint32_t leaf = OVC_NO_LEAF;
        enum : uint32_t { Done, Ready, Waits } state = Done;
    };

    void start_one(uint32_t i, const Box& scene) {
        positions_[i] = {};
        query_.set_miss(i);
        if (!query_.rays[i].valid()) {
            ++invalid_;
            return;
        }
        const PreparedRay p = prepare(query_, i);
        // First: from where double cannot walk, rounding may carry a ray past the whole scene.
        if (!can_walk(s_.level1_, p))
            decide_in_double(i, p);
        else if (!clip(p, scene, p.ray.t_min, p.ray.t_max).empty())
            positions_[i] = {p.ray.t_min, p.ray.t_max, OVC_NO_LEAF, Position::Ready};
    }

    void send_on(std::span<const uint32_t> rays) {
        for (const uint32_t i : rays) {
            if (positions_[i].state == Position::Ready)
                ready_.push_back(i);
            else if (positions_[i].state == Position::Waits)
                waiting_.push(positions_[i].leaf, i);
            else
                finished_.push_back(i);
        }
    }

    /// Takes in the kernel's answer for ray i, and says in positions_[i] where the ray goes from
    /// here.
    void settle_one(uint32_t i, const Answer& answer) {
        positions_[i].state = Position::Done;
        if (answer.prim == OVC_WAITS) {
            positions_[i] = {answer.t(), positions_[i].t_end, answer.leaf(), Position::Waits};
            return;
        }
        const bool decided = answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
        capped_ += answer.prim == OVC_CAPPED;
        if (!decided || !(s_.options_.certify ? take_in(i, answer) : take_in_fast(i, answer)))
            decide_in_double(i, prepare(query_, i));
    }

    /// Enters what the kernel found. False where double does not find what the kernel was certain
    /// of, or cannot say where to go on.
    bool take_in(uint32_t i, const Answer& answer) {
        const bool has_rivals = answer.rivals()[0] != OVC_NO_TRIANGLE;
        if (answer.prim == OVC_MISS && !has_rivals)
            return true;
        const uint32_t leaf = answer.leaf();
        const bool in_scene = leaf == OVC_NO_LEAF; // linked pages: no other leaf is left
        if (!in_scene && used_[leaf].load(std::memory_order_relaxed) == 0)
            used_[leaf].store(1, std::memory_order_relaxed);
        if (Query::kAnyHit && !has_rivals) {
            query_.set(i, Hit{0, 0, 0, s_.numbers_.id(answer.prim)}); // a certain hit decides
            return true;
        }
        const PreparedRay p = prepare(query_, i);
        Nearest nearest(p);
        if (query_.was_hit(i))
            offer(nearest, s_.numbers_.of(query_.hit(i).id), p.skip);
        if (answer.prim != OVC_MISS && !offer(nearest, answer.prim, p.skip))
            return false;
        for (const uint32_t rival : answer.rivals())
            if (rival != OVC_NO_TRIANGLE)
                offer(nearest, rival, p.skip);
        if (nearest.hit().is_hit())
            query_.set(i, nearest.hit());
        const bool settled = in_scene || (Query::kAnyHit && nearest.hit().is_hit()) ||
                             go_on_behind(i, leaf, p, nearest.limit());
        if (settled && has_rivals) // decide_in_double() counts the others
            count_flagged(i);
        return settled;
    }

    /// Sends the ray on unless its best hit, which is not beyond `end` however t is rounded, lies
    /// in the leaf's cell: then nothing of later cells is nearer, nor as near. False where rounding
    /// would send it back: t must grow, or two cells at a corner pass a ray to and fro.
    bool go_on_behind(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        const Box& cell = s_.level1_.leaves[leaf].cell;
        const Box safe = cell.padded(-p.margin(cell)); // no rounding leads out of the cell
        const double exit = clip(p, cell, p.ray.t_min, p.ray.t_max).exit;
        if (end <= clip(p, safe, p.ray.t_min, p.ray.t_max).exit || exit >= end)
            return true;
        if (exit <= positions_[i].t_from)
            return false;
        positions_[i] = {exit, end, leaf + 1, Position::Ready};
        return true;
    }

    bool take_in_fast(uint32_t i, const Answer& answer) {
        if (answer.prim != OVC_MISS)
            query_.set(
                i, s_.twins_.seen(s_.soup_,
                                  {answer.t(), answer.u(), answer.v(), s_.numbers_.id(answer.prim)},
                                  query_.skipped(i)));
        return true;
    }

    /// Offers what stands in the page as `number`.
    bool offer(Nearest& nearest, uint32_t number, TriangleId skip) const {
        const TriangleId seen = s_.twins_.seen(s_.numbers_.id(number), skip);
        return nearest.offer(s_.soup_.triangle(seen), seen);
    }

    void decide_in_double(uint32_t i, const PreparedRay& p) {
        query_.set(i, arbitrate<Query::kAnyHit>(s_.soup_, s_.numbers_, s_.twins_, s_.level1_,
                                                s_.pages_, p));
        count_flagged(i);
        ++retraced_;
    }

    void count_flagged(uint32_t i) {
        query_.flag(i);
        ++flagged_;
    }

    TwoLevel& s_;
    Query query_;
    std::vector<Position> positions_; // per ray
    std::vector<uint32_t> ready_;     // rays for the next passes
    std::vector<uint32_t> batch_;     // loaded last
    std::vector<uint32_t> finished_;
    Waiting waiting_;
    std::vector<std::atomic<uint8_t>> used_; // per leaf: a ray of the last pass ended there
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

template <class... Queries>
std::vector<uint32_t> TwoLevel::wanted_by(const Wave<Queries>&... waves) const {
    if ((waves.ready() + ...) >= few_rays() || (waves.waiting() + ...) == 0)
        return {};
    std::vector<size_t> counts(pages_.size());
    for (uint32_t leaf = 0; leaf < counts.size(); ++leaf)
        counts[leaf] = (waves.queues().count(leaf) + ...);
    return worth_moving(counts, pages_);
}

template <class Meanwhile, class... Queries>
Result<Done> TwoLevel::round(size_t most, Meanwhile&& meanwhile, Wave<Queries>&... waves) {
    // What is ready goes with the next pass, whose greater part then comes from the pages moved
    // in: so every pass gets somewhere, though those pages may push out what was ready for.
    const std::vector<uint32_t> before = wanted_by(waves...);
    const auto moved = std::span(before).first(before.empty() ? 0 : bring(before));
    (waves.call_up(moved), ...);
    if ((waves.ready() + ...) == 0)
        return lost(); // nothing could be moved in
    most = std::min<size_t>(most, plan_.batch_rays);
    travellers_.resize(whole_blocks(std::min<size_t>((waves.ready() + ...), most)));
    size_t count = 0;
    const auto load = [&](auto& wave) {
        const size_t room = std::min(travellers_.size(), most) - count;
        const size_t loaded = wave.load(std::span(travellers_).subspan(count, room));
        count += loaded;
        return loaded;
    };
    const size_t loaded[] = {load(waves)...};
    const std::vector<uint32_t> beside = options_.beside.value_or(!gl_.info().is_software)
                                             ? wanted_by(waves...)
                                             : std::vector<uint32_t>();
    const Result<size_t> moved_beside = pass(count, beside, meanwhile);
    if (!moved_beside)
        return moved_beside.error();
    size_t first = 0;
    size_t k = 0;
    const auto settle = [&](auto& wave) {
        wave.settle(std::span(answers_).subspan(first, loaded[k]));
        first += loaded[k++];
    };
    (settle(waves), ...);
    (waves.call_up(std::span(beside).first(*moved_beside)), ...);
    return Done{};
}

} // namespace ovc
