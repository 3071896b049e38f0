// SPDX-License-Identifier: Apache-2.0
// QueuedRays: a ray goes from level 1 into a queue, through a pass, and back. Candidates that the
// kernel leaves open are resolved.
#include "plugin/thesis/queued/queued_rays.h"

#include "core/system/parallel.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/resolve/candidates.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {

/// In fast precision, how far a hit may lie beyond the cell, as a share of the leaf: 16 roundings.
static constexpr double kFastSlack = 0x1p-20;
namespace {

constexpr size_t kQueueGrain = 256; // rays per task

/// Returns the part of the ray that is still of interest.
PreparedRay rest_of(const QueuedRay& state) {
    Ray rest = state.ray;
    rest.t_max = state.t_end;
    return PreparedRay(rest, state.skip);
}

} // namespace

QueuedRays::~QueuedRays() {
    s_.statistics.invalid_rays += invalid_;
    s_.statistics.flagged += flagged_;
    s_.statistics.retraced += retraced_;
    s_.statistics.capped += capped_;
}

uint32_t QueuedRays::slot() {
    if (free_.empty()) {
        states_.emplace_back();
        return uint32_t(states_.size() - 1);
    }
    const uint32_t i = free_.back();
    free_.pop_back();
    return i;
}

void QueuedRays::add(bool any_hit, const RaySpan& rays, const Exclusions& without,
                     std::span<const uint64_t> tokens) {
    assert(under_way() + rays.size() <= kMax);
    assert(tokens.size() == rays.size() && without.are_for(rays.size()));
    for (size_t i = 0; i < rays.size(); ++i) {
        const uint32_t at = slot();
        states_[at] = {rays[i], without[i].skip, tokens[i], any_hit};
        level1_queue_.push_back(at);
    }
    (any_hit ? s_.statistics.occlusion_rays : s_.statistics.nearest_rays) += rays.size();
}

void QueuedRays::walk_level1() {
    parallel_for(level1_queue_.size(), kQueueGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j)
            find_leaf(states_[level1_queue_[j]]);
    });
    for (const uint32_t i : level1_queue_)
        if (states_[i].leaf == kNone)
            answered_.push_back(i);
        else
            queues_.push(states_[i].leaf, i);
    level1_queue_.clear();
}

void QueuedRays::find_leaf(QueuedRay& state) {
    state.leaf = kNone;
    if (state.step == QueuedRay::New)
        begin(state);
    if (state.step == QueuedRay::Answered)
        return;
    const PreparedRay rest = rest_of(state);
    state.leaf = state.step == QueuedRay::InLastCell
                     ? next_leaf_in_cell(s_.built.level1, rest, state.place).leaf
                     : next_leaf(s_.walk, s_.built.level1, rest, state.place).leaf;
}

void QueuedRays::begin(QueuedRay& state) {
    assert(state.step == QueuedRay::New);
    state.step = QueuedRay::Answered;
    if (!state.ray.valid()) {
        ++invalid_;
        return;
    }
    if (!can_walk(s_.built.level1, PreparedRay(state.ray))) {
        fall_back(state);
        return;
    }
    state.place.cells.t = state.ray.t_min;
    state.t_end = state.ray.t_max;
    state.step = QueuedRay::Walking;
}

Result<Done> QueuedRays::trace_next_leaf() {
    assert(waiting());
    const uint32_t leaf =
        queues_.choose([&](uint32_t l) { return s_.passes->resident(l); }, s_.built.pages);
    const std::vector<uint32_t> queue = queues_.take(leaf);
    const size_t max_rays = s_.plan.batch_rays;
    for (size_t at = 0; at < queue.size(); at += max_rays)
        if (Result<Done> done =
                pass(leaf, std::span(queue).subspan(at, std::min(max_rays, queue.size() - at)));
            !done)
            return done;
    return Done{};
}

Result<Done> QueuedRays::pass(uint32_t leaf, std::span<const uint32_t> queued) {
    assert(!queued.empty() && queued.size() <= s_.plan.batch_rays);
    std::vector<uint32_t> batch(queued.begin(), queued.end());
    const auto occlusion = std::stable_partition(batch.begin(), batch.end(),
                                                 [&](uint32_t i) { return !states_[i].any_hit; });
    load(leaf, batch);
    Result<LeafPass> pass = Error{};
    s_.gl.run([&](GlState&) {
        pass = s_.passes->run(leaf, rays_, size_t(occlusion - batch.begin()), answers_);
    });
    if (!pass)
        return pass.error();
    s_.statistics.passes += 1;
    s_.statistics.ray_visits += batch.size();
    s_.statistics.pages_in += pass->bytes_in > 0;
    s_.statistics.bytes_in += pass->bytes_in;
    s_.statistics.seconds_pass += pass->seconds;
    s_.statistics.seconds_kernel = s_.statistics.seconds_pass;
    parallel_for(batch.size(), kQueueGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j)
            resolve(states_[batch[j]], answers_[j], decidable_[j]);
    });
    level1_queue_.insert(level1_queue_.end(), batch.begin(), batch.end());
    return Done{};
}

/// Fills rays_ with the batch in the leaf's frame.
void QueuedRays::load(uint32_t leaf, std::span<const uint32_t> batch) {
    rays_.assign(LeafPasses::row_padded(batch.size()), FrameRay{});
    answers_.resize(rays_.size());
    decidable_.resize(rays_.size());
    parallel_for(batch.size(), kQueueGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j) {
            const QueuedRay& state = states_[batch[j]];
            bool decidable = true;
            rays_[j] = frame_ray(s_.built.level1.leaves[leaf], rest_of(state), decidable);
            rays_[j].skip = s_.built.number_to_skip(state.skip);
            decidable_[j] = decidable;
        }
    });
}

void QueuedRays::resolve(QueuedRay& state, const FrameAnswer& answer, bool decidable) {
    const bool capped = decidable && answer.prim == OVC_CAPPED;
    capped_ += capped;
    if (!decidable || capped || answer.prim == OVC_FLAGGED)
        fall_back(state);
    else if (!s_.certify)
        enter_fast(state, answer);
    else if (!resolve_candidates(state, answer))
        fall_back(state);
}

/// Enters the kernel's candidates of the leaf, as exact arithmetic decides them. Returns false
/// where it does not confirm the certain hit.
bool QueuedRays::resolve_candidates(QueuedRay& state, const FrameAnswer& answer) {
    const std::array<uint32_t, 2> further = answer.further();
    const Candidates found{answer.prim, further};
    if (found.is_miss())
        return true;
    if (state.any_hit && found.is_certain_hit()) {
        state.hit = {0, 0, 0, s_.built.numbers.id(found.certain)};
        state.step = QueuedRay::Answered;
        return true;
    }
    const PreparedRay p(state.ray, state.skip);
    Nearest nearest(p);
    if (state.hit.is_hit())
        s_.built.offer(nearest, p, state.hit.id);
    if (!found.offer_to(nearest, p, s_.built))
        return false;
    flagged_ += found.has_further(); // fall_back() counts the others
    state.hit = state.any_hit ? nearest.unrounded_hit() : nearest.hit();
    if (state.hit.is_hit())
        end_at(state, p, nearest.limit(), -p.margin(s_.built.level1.leaves[state.leaf].cell));
    return true;
}

void QueuedRays::enter_fast(QueuedRay& state, const FrameAnswer& answer) {
    if (answer.prim == OVC_MISS)
        return;
    const Leaf& leaf = s_.built.level1.leaves[state.leaf];
    const PreparedRay p(state.ray, state.skip);
    const double t = world_t(leaf, p, answer.t());
    const Hit hit =
        s_.built.seen({t, answer.u(), answer.v(), s_.built.numbers.id(answer.prim)}, state.skip);
    if (hit.nearer_than(state.hit))
        state.hit = hit;
    // t is only as good as float, so a hit on the cell's last plane may come out behind it.
    const double slack = kFastSlack / leaf.frame.scale;
    end_at(state, p, state.hit.t + slack / std::abs(p.ray.dir[p.kz]), 2 * slack);
}

/// Notes a hit that is not beyond `end` however t is rounded. If `end` lies in the leaf's cell,
/// larger by `slack`, the ray is in its last cell: later ones hold no hit as near.
void QueuedRays::end_at(QueuedRay& state, const PreparedRay& p, double end, double slack) {
    state.t_end = std::min(state.t_end, end);
    const Box cell = s_.built.level1.leaves[state.leaf].cell.padded(slack);
    if (state.any_hit)
        state.step = QueuedRay::Answered;
    else if (s_.walk.along_the_ray() && end <= clip(p, cell, p.ray.t_min, p.ray.t_max).exit)
        state.step = QueuedRay::InLastCell;
}

void QueuedRays::fall_back(QueuedRay& state) {
    const PreparedRay p(state.ray, state.skip);
    state.hit =
        state.any_hit ? trace_exactly<true>(s_.built, p) : trace_exactly<false>(s_.built, p);
    state.step = QueuedRay::Answered;
    ++flagged_;
    ++retraced_;
}

} // namespace ovc::thesis
