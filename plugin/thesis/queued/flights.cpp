// SPDX-License-Identifier: Apache-2.0
// Flights: from level 1 into a queue, through a pass, and back; what the kernel leaves is resolved.
#include "plugin/thesis/queued/flights.h"

#include "core/system/parallel.h"
#include "plugin/two_level/candidates.h"
#include "plugin/two_level/exact_fallback.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {

/// Fast precision: of a leaf, by how much a hit may lie beyond the cell; 16 roundings.
static constexpr double kFastSlack = 0x1p-20;
namespace {

constexpr size_t kGrain = 256; // rays a task

/// What is left of it.
PreparedRay rest_of(const Flight& flight) {
    Ray rest = flight.ray;
    rest.t_max = flight.t_end;
    return PreparedRay(rest, flight.skip);
}

} // namespace

Flights::~Flights() {
    s_.statistics.invalid_rays += invalid_;
    s_.statistics.flagged += flagged_;
    s_.statistics.retraced += retraced_;
    s_.statistics.capped += capped_;
}

uint32_t Flights::slot() {
    if (free_.empty()) {
        flights_.emplace_back();
        return uint32_t(flights_.size() - 1);
    }
    const uint32_t i = free_.back();
    free_.pop_back();
    return i;
}

void Flights::add(bool any_hit, const RaySpan& rays, std::span<const TriangleId> skip,
                  std::span<const uint64_t> tokens) {
    assert(under_way() + rays.size() <= kMost);
    for (size_t i = 0; i < rays.size(); ++i) {
        const uint32_t at = slot();
        flights_[at] = {rays[i], skip.empty() ? TriangleId{} : skip[i], tokens[i], any_hit};
        level1_queue_.push_back(at);
    }
    (any_hit ? s_.statistics.occlusion_rays : s_.statistics.nearest_rays) += rays.size();
}

void Flights::walk_level1() {
    parallel_for(level1_queue_.size(), kGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j)
            find_leaf(flights_[level1_queue_[j]]);
    });
    for (const uint32_t i : level1_queue_)
        if (flights_[i].leaf == kNone)
            answered_.push_back(i);
        else
            queues_.push(flights_[i].leaf, i);
    level1_queue_.clear();
}

void Flights::find_leaf(Flight& flight) {
    flight.leaf = kNone;
    if (flight.state == Flight::New)
        begin(flight);
    if (flight.state == Flight::Answered)
        return;
    const PreparedRay rest = rest_of(flight);
    flight.leaf = flight.state == Flight::InLastCell
                      ? next_leaf_in_cell(s_.built.level1, rest, flight.place).leaf
                      : next_leaf(s_.walk, s_.built.level1, rest, flight.place).leaf;
}

void Flights::begin(Flight& flight) {
    flight.state = Flight::Answered;
    if (!flight.ray.valid()) {
        ++invalid_;
        return;
    }
    if (!can_walk(s_.built.level1, PreparedRay(flight.ray))) {
        fall_back(flight);
        return;
    }
    flight.place.cells.t = flight.ray.t_min;
    flight.t_end = flight.ray.t_max;
    flight.state = Flight::Walking;
}

Result<Done> Flights::trace_next_leaf() {
    const uint32_t leaf =
        queues_.choose([&](uint32_t l) { return s_.passes->resident(l); }, s_.built.pages);
    const std::vector<uint32_t> queue = queues_.take(leaf);
    const size_t most = s_.plan.batch_rays;
    for (size_t at = 0; at < queue.size(); at += most)
        if (Result<Done> done =
                pass(leaf, std::span(queue).subspan(at, std::min(most, queue.size() - at)));
            !done)
            return done;
    return Done{};
}

Result<Done> Flights::pass(uint32_t leaf, std::span<const uint32_t> queued) {
    std::vector<uint32_t> batch(queued.begin(), queued.end());
    const auto occlusion = std::stable_partition(batch.begin(), batch.end(),
                                                 [&](uint32_t i) { return !flights_[i].any_hit; });
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
    parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j)
            resolve(flights_[batch[j]], answers_[j], decidable_[j]);
    });
    level1_queue_.insert(level1_queue_.end(), batch.begin(), batch.end());
    return Done{};
}

/// The rays in the leaf's frame.
void Flights::load(uint32_t leaf, std::span<const uint32_t> batch) {
    rays_.assign(LeafPasses::row_padded(batch.size()), FrameRay{});
    answers_.resize(rays_.size());
    decidable_.resize(rays_.size());
    parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
        for (size_t j = from; j < to; ++j) {
            const Flight& flight = flights_[batch[j]];
            bool decidable = true;
            rays_[j] = frame_ray(s_.built.level1.leaves[leaf], rest_of(flight), decidable);
            rays_[j].skip = s_.built.number_to_skip(flight.skip);
            decidable_[j] = decidable;
        }
    });
}

void Flights::resolve(Flight& flight, const FrameAnswer& answer, bool decidable) {
    const bool capped = decidable && answer.prim == OVC_CAPPED;
    capped_ += capped;
    if (!decidable || capped || answer.prim == OVC_FLAGGED)
        fall_back(flight);
    else if (!s_.certify)
        enter_fast(flight, answer);
    else if (!resolve_candidates(flight, answer))
        fall_back(flight);
}

/// Enters the kernel's candidates of the leaf, as exact arithmetic decides them. False where it
/// does not confirm the certain hit.
bool Flights::resolve_candidates(Flight& flight, const FrameAnswer& answer) {
    const Candidates found{answer.prim, answer.rivals()};
    if (found.is_miss())
        return true;
    if (flight.any_hit && found.is_certain_hit()) {
        flight.hit = {0, 0, 0, s_.built.numbers.id(found.certain)};
        flight.state = Flight::Answered;
        return true;
    }
    const PreparedRay p(flight.ray, flight.skip);
    Nearest nearest(p);
    if (flight.hit.is_hit())
        s_.built.offer(nearest, flight.hit.id);
    if (!found.offer_to(nearest, s_.built, p.skip))
        return false;
    flagged_ += found.has_further(); // fall_back() counts the others
    flight.hit = flight.any_hit ? nearest.unrounded_hit() : nearest.hit();
    if (flight.hit.is_hit())
        end_at(flight, p, nearest.limit(), -p.margin(s_.built.level1.leaves[flight.leaf].cell));
    return true;
}

void Flights::enter_fast(Flight& flight, const FrameAnswer& answer) {
    if (answer.prim == OVC_MISS)
        return;
    const Leaf& leaf = s_.built.level1.leaves[flight.leaf];
    const PreparedRay p(flight.ray, flight.skip);
    const double t = world_t(leaf, p, answer.t());
    const Hit hit =
        s_.built.seen({t, answer.u(), answer.v(), s_.built.numbers.id(answer.prim)}, flight.skip);
    if (hit.nearer_than(flight.hit))
        flight.hit = hit;
    // t is as good as float is: what lies on the cell's last plane may come out behind it.
    const double slack = kFastSlack / leaf.frame.scale;
    end_at(flight, p, flight.hit.t + slack / std::abs(p.ray.dir[p.kz]), 2 * slack);
}

/// The ray was hit, not beyond `end` however t is rounded. It is in its last cell where that lies
/// in the leaf's cell, larger by `slack`: then nothing of later cells is nearer, nor as near.
void Flights::end_at(Flight& flight, const PreparedRay& p, double end, double slack) {
    flight.t_end = std::min(flight.t_end, end);
    const Box cell = s_.built.level1.leaves[flight.leaf].cell.padded(slack);
    if (flight.any_hit)
        flight.state = Flight::Answered;
    else if (s_.walk.along_the_ray() && end <= clip(p, cell, p.ray.t_min, p.ray.t_max).exit)
        flight.state = Flight::InLastCell;
}

void Flights::fall_back(Flight& flight) {
    const PreparedRay p(flight.ray, flight.skip);
    flight.hit =
        flight.any_hit ? trace_exactly<true>(s_.built, p) : trace_exactly<false>(s_.built, p);
    flight.state = Flight::Answered;
    ++flagged_;
    ++retraced_;
}

} // namespace ovc::thesis
