// SPDX-License-Identifier: Apache-2.0
// Two-level: building, and the loop over passes.
#include "plugin/two_level.h"

#include "core/stopwatch.h"
#include "gpu/level1_table.h"
#include "gpu/linked.h"
#include "plugin/level2.h"
#include "plugin/one_pass.h"
#include "plugin/page_rate.h"
#include "plugin/smallest_budget.h"
#include "plugin/wave.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace ovc {
namespace {

constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
// A page takes at most this share of the pool, so that some stay resident; and where leaves are
// ours to choose, this one, so that rays bring in little that they do not go through: but it is
// worth a move.
constexpr uint64_t kPagesAtOnce = 3;
constexpr uint64_t kPagesByDefault = 32;
constexpr uint64_t kWorthMoving = 512 << 10; // bytes
constexpr uint64_t kDefaultLeaves = 10;      // thesis, section 4

} // namespace

uint64_t budget_of(const TwoLevelOptions& options, const DeviceInfo& device) {
    return options.budget_bytes ? options.budget_bytes : device.default_budget_bytes();
}

Result<Done> check_budget(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                          const DeviceInfo& device) {
    const SmallestCut cut =
        smallest_cut(soup.triangle_count(), options.leaf_triangles, options.tell_active);
    if (plan.pool_bytes >= cut.pool_bytes)
        return Done{};
    return over_budget(fmt::format(
        "a GPU budget of {} bytes is too small for this scene: the smallest that works is {} "
        "bytes ({} triangles in leaves of {}, whose table and largest page take {}; an eighth is "
        "for rays)",
        plan.budget_bytes, smallest_budget(cut.pool_bytes, device), soup.triangle_count(),
        cut.leaf_triangles, cut.pool_bytes));
}

/// The most that a page may take of the pool: a third, so that some stay resident; half of it where
/// the table of as many leaves might not find room beside that.
static uint64_t share_of_page(const MemoryPlan& plan, uint64_t triangles) {
    constexpr uint64_t kTexelsPerLeaf = OVC_LEAF_TEXELS + 2; // two nodes of level 1
    const uint64_t page_bytes = std::max<uint64_t>(plan.pool_bytes / kPagesAtOnce, 1);
    const uint64_t leaves = triangles * kMostBytesPerTriangle / page_bytes;
    const uint64_t table = leaves * kTexelsPerLeaf * sizeof(uvec4);
    return table + page_bytes <= plan.pool_bytes ? page_bytes : plan.pool_bytes / 2;
}

LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan, uint64_t triangles) {
    // Halving ends between half full and full: this much on average gives about so many leaves.
    constexpr double kFull = 0.7;
    constexpr uint64_t kMostPageBytes = uint64_t(OVC_MAX_UNITS - 1) * OVC_UNIT_BYTES;
    const uint64_t page_bytes = std::min(share_of_page(plan, triangles), kMostPageBytes);
    if (options.leaf_triangles)
        return {options.leaf_triangles, page_bytes};
    double most = double(triangles) / double(kDefaultLeaves);
    if (options.leaves)
        most = double(triangles) / (options.leaves == 1 ? 1 : kFull * options.leaves);
    LeafLimits limits{std::max<uint64_t>(uint64_t(std::ceil(most)), 1), page_bytes};
    if (!options.leaves) {
        limits.page_bytes = std::min(
            page_bytes, std::max<uint64_t>(plan.pool_bytes / kPagesByDefault, kWorthMoving));
        const uint64_t table = level1_texels(1, 1) * sizeof(uvec4) + sizeof(uint32_t);
        const uint64_t room =
            std::min(plan.pool_bytes - std::min(plan.pool_bytes, table), kMostPageBytes);
        limits.whole_bytes = triangles <= room / kMostBytesPerTriangle ? LeafLimits::kAny : room;
    }
    return limits;
}

Result<Done> check_count(const Soup& soup) {
    if (soup.triangle_count() > OVC_MAX_TRIANGLES)
        return Error{fmt::format("{} triangles are too many: a scene takes {}",
                                 soup.triangle_count(), OVC_MAX_TRIANGLES),
                     ErrorKind::InvalidArgument};
    return Done{};
}

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log, BuildProgress* progress) {
    const Result<MemoryPlan> plan = plan_memory(budget_of(options, gl.info()), gl.info());
    if (!plan)
        return plan.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(soup, gl, options, *plan, log));
    self->plan_.driver_bytes = options.driver_bytes;

    if (const Result<Done> fine = check_count(soup); !fine)
        return fine.error();
    if (const Result<Done> enough = check_budget(soup, options, *plan, gl.info()); !enough)
        return enough.error();
    self->numbers_ = Numbering(soup);
    if (!self->restore(options.saved))
        if (const Result<Done> made = self->make_levels(progress); !made)
            return made.error();
    self->warn_of_dropped();
    self->count_levels();
    if (self->pages_.empty())
        return self; // every ray misses, no GPU needed
    self->share_out();

    const Result<Done> made = self->make_tracer(progress);
    if (made)
        return self;
    if (made.error().kind != ErrorKind::OutOfGpuMemory || self->pages_.size() > 1 ||
        options.leaf_triangles || options.leaves)
        return made.error();
    say(log, LogLevel::Warning, "cutting the scene into leaves, of which the GPU holds some");
    TwoLevelOptions cut = options;
    cut.leaf_triangles = self->limits_.triangles;
    self.reset();
    return build(soup, gl, cut, log, progress);
}

/// Level 1 and level 2 from the soup.
Result<Done> TwoLevel::make_levels(BuildProgress* progress) {
    const Stopwatch watch;
    begin(progress, "triangles", 0.1, 2 * soup_.triangle_count());
    Box bounds;
    std::vector<TriangleId> triangles =
        hittable_triangles(soup_, &statistics_.dropped, &bounds, progress);
    twins_ = Twins::take_out(soup_, triangles, progress);
    statistics_.seconds_level1 = watch.seconds();
    triangles_ = triangles.size();
    limits_ = limits_of(options_, plan_, triangles_);
    Result<Levels> levels = build_levels(soup_, numbers_, triangles, bounds, limits_, progress);
    if (!levels)
        return levels.error();
    take(std::move(*levels));
    if (has_room())
        return Done{};
    const SmallestCut cut =
        smallest_cut(soup_.triangle_count(), options_.leaf_triangles, options_.tell_active);
    take(build_smallest_levels(soup_, numbers_, std::move(triangles), bounds, cut.leaf_triangles,
                               progress));
    assert(has_room()); // see check_budget()
    return Done{};
}

void TwoLevel::take(Levels levels) {
    level1_ = std::move(levels.level1);
    pages_ = std::move(levels.pages);
    statistics_.seconds_level1 += levels.seconds_level1;
    statistics_.seconds_level2 += levels.seconds_level2;
}

/// Of the pool, for level 1.
uint64_t TwoLevel::table_bytes() const {
    const uint64_t active_bytes = options_.tell_active ? pages_.size() * sizeof(uint32_t) : 0;
    return level1_texels(level1_) * sizeof(uvec4) + active_bytes;
}

/// Whether the pool holds level 1 and each of the pages.
bool TwoLevel::has_room() const {
    uint64_t largest = 0;
    for (const Page& page : pages_)
        largest = std::max(largest, page.bytes());
    return pages_.empty() || table_bytes() + largest <= plan_.pool_bytes;
}

/// The same from what was saved; false where that will not do, and level 1 is to be made.
bool TwoLevel::restore(Bytes saved) {
    if (saved.empty())
        return false;
    const Stopwatch watch;
    Result<std::optional<BuiltLevels>> found = restore_levels(
        saved, soup_, [&](uint64_t triangles) { return limits_of(options_, plan_, triangles); });
    if (!found) {
        say(log_, LogLevel::Warning,
            fmt::format("building anew: what was saved {}", found.error().message));
        return false;
    }
    if (!*found) {
        say(log_, LogLevel::Info,
            "building anew: what was saved is of other meshes or other options");
        return false;
    }
    BuiltLevels& levels = **found;
    statistics_.dropped = levels.dropped;
    twins_ = std::move(levels.twins);
    triangles_ = levels.triangles;
    limits_ = levels.limits;
    level1_ = std::move(levels.level1);
    pages_ = std::move(levels.pages);
    statistics_.seconds_level1 = watch.seconds();
    statistics_.from_saved = has_room();
    return statistics_.from_saved;
}

Result<Done> TwoLevel::save(const ByteSink& sink) const {
    if (!save_levels(soup_, {statistics_.dropped, twins_, triangles_, limits_, level1_, pages_},
                     sink))
        return Error{"saving was stopped", ErrorKind::Cancelled};
    return Done{};
}

void TwoLevel::warn_of_dropped() const {
    const Dropped& dropped = statistics_.dropped;
    if (dropped.not_finite)
        say(log_, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner", dropped.not_finite));
    if (dropped.degenerate)
        say(log_, LogLevel::Warning,
            fmt::format("left out {} triangles without area", dropped.degenerate));
}

void TwoLevel::count_levels() {
    statistics_.twins = twins_.count();
    for (const Page& page : pages_) {
        statistics_.level2_bytes += page.bytes();
        statistics_.largest_page_bytes = std::max(statistics_.largest_page_bytes, page.bytes());
    }
    statistics_.host_bytes =
        statistics_.level2_bytes + level1_.reference_count() * sizeof(TriangleId) +
        level1_.leaves.size() * sizeof(Leaf) + level1_.nodes.size() * sizeof(KdNode);
}

/// The pool and what rays need, in the context there is now; smaller where the driver has no room.
Result<Done> TwoLevel::make_tracer(BuildProgress* progress) {
    while (true) {
        Result<std::unique_ptr<Tracer>> made = Error{};
        gl_.run([&](GlState& state) {
            tracer_.reset();
            tracer_generation_ = state.generation;
            if (state.context.alive())
                made = Tracer::create(plan_, {options_.certify, options_.compute}, gl_.info(),
                                      state.kernels, level1_, pages_);
            else
                made = Error{"the GPU's context is lost", ErrorKind::DeviceLost};
        });
        if (made) {
            tracer_ = std::move(*made);
            break;
        }
        if (made.error().kind == ErrorKind::DeviceLost)
            return lost();
        if (made.error().kind != ErrorKind::OutOfGpuMemory)
            return made.error();
        const uint64_t smaller = std::max(plan_.pool_bytes / 2, statistics_.largest_page_bytes);
        if (smaller == plan_.pool_bytes)
            return Error{fmt::format("{}: it has no room for the largest page, {} bytes",
                                     made.error().message, smaller),
                         ErrorKind::OutOfGpuMemory};
        say(log_, LogLevel::Warning,
            fmt::format("the GPU has no room for a pool of {} bytes; going on with {}",
                        plan_.pool_bytes, smaller));
        plan_.pool_bytes = smaller;
    }
    bring_first(progress);
    statistics_.peak_bytes = std::max(statistics_.peak_bytes, tracer_->ledger().peak);
    return Done{};
}

/// Makes anew what went with an earlier context, or with purge().
Result<Done> TwoLevel::ready_device() {
    if (pages_.empty() || (tracer_ && tracer_generation_ == gl_.generation()))
        return Done{};
    return make_tracer(nullptr);
}

Result<Done> TwoLevel::purge() {
    if (tracer_)
        gl_.run([&](GlState&) { tracer_.reset(); });
    batches_ = {};
    return Done{};
}

/// The context is dead: a new one for the calls to come.
Error TwoLevel::lost() {
    const Result<Done> again = gl_.reopen(tracer_generation_);
    return {fmt::format("the GPU's context was lost{}",
                        again ? "; the device is open again, and the next call will work"
                              : ", and the device does not open again: " + again.error().message),
            ErrorKind::DeviceLost};
}

/// Moves in the first pages, as many as fit, so that rays need not come and wait first.
void TwoLevel::bring_first(BuildProgress* progress) {
    constexpr uint64_t kBytesAtOnce = 32 << 20; // between two looks whether to stop
    begin(progress, "moving pages to the GPU", 0.05, plan_.pool_bytes);
    uint64_t room = plan_.pool_bytes;
    for (size_t next = 0; next < pages_.size() && pages_[next].bytes() <= room;) {
        std::vector<uint32_t> some;
        uint64_t bytes = 0;
        for (; next < pages_.size() && pages_[next].bytes() <= room && bytes < kBytesAtOnce;
             ++next) {
            some.push_back(uint32_t(next));
            bytes += pages_[next].bytes();
            room -= pages_[next].bytes();
        }
        bring(some);
        add(progress, bytes);
    }
}

TwoLevel::~TwoLevel() {
    if (tracer_)
        gl_.run([&](GlState&) { tracer_.reset(); });
}

/// Takes level 1 off the pool, and what no page needs.
void TwoLevel::share_out() {
    plan_.active_bytes = options_.tell_active ? pages_.size() * sizeof(uint32_t) : 0;
    plan_.pool_bytes = std::min(plan_.pool_bytes - table_bytes(),
                                most_linked_bytes(statistics_.level2_bytes, pages_.size()));
}

/// Moves the first pages of `wanted` in, as many as fit; returns how many.
size_t TwoLevel::bring(std::span<const uint32_t> wanted) {
    Moved moved;
    gl_.run([&](GlState& state) {
        if (is_ours(state))
            moved = tracer_->bring(wanted);
    });
    statistics_.pages_in += moved.pages;
    statistics_.bytes_in += moved.bytes;
    return moved.pages;
}

/// The number of a triangle that a ray shall not see; OVC_NO_TRIANGLE where it stands for others,
/// which are to be found.
uint32_t TwoLevel::number_to_skip(TriangleId id) const {
    return id.mesh == kNone || twins_.stands_for_others(id) ? OVC_NO_TRIANGLE : numbers_.of(id);
}

/// The rays of the batch on their way; their answers into it. Beside them, pages of `wanted` are
/// moved in; returns how many.
Result<size_t> TwoLevel::pass(Batch& batch, std::span<const uint32_t> wanted,
                              const std::function<void()>& meanwhile) {
    const size_t count = batch.rays.size();
    const Traveller none{{dvec3(0), 0, dvec3(0, 0, 1), -1}, 0, OVC_NO_TRIANGLE, OVC_NO_LEAF};
    std::fill_n(batch.travellers.begin() + ptrdiff_t(count), whole_blocks(count) - count, none);
    Result<Done> done = Done{};
    bool alive = false;
    Moved moved;
    double seconds = 0;
    const auto work = [&](GlState& state) {
        const Stopwatch watch;
        alive = is_ours(state);
        if (!alive)
            return;
        done = tracer_->submit(std::span(batch.travellers).first(count));
        if (done)
            moved = tracer_->bring(wanted);
        if (done)
            done = tracer_->collect(std::span(batch.answers).first(count));
        alive = state.context.alive(); // else what was read is anything
        seconds = watch.seconds();
    };
    gl_.run_beside(work, meanwhile, [this] { keeps_on(); });
    if (!alive)
        return lost();
    if (!done)
        return done.error();
    statistics_.passes += 1;
    statistics_.ray_visits += count;
    statistics_.seconds_pass += seconds;
    seconds_a_ray_ = seconds / double(count);
    statistics_.seconds_kernel += tracer_->kernel_seconds();
    statistics_.pages_in += moved.pages;
    statistics_.bytes_in += moved.bytes;
    return size_t(moved.pages);
}

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const Stopwatch watch;
    if (Result<Done> ready = ready_device(); !ready)
        return ready;
    const bool linked = tracer_ && tracer_->all_linked();
    const Result<Done> done = linked ? trace_in_one_pass(query) : trace_in_waves(query);
    if (!done)
        return done;
    (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += query.rays.size();
    statistics_.seconds_trace += watch.seconds();
    return unless_cancelled();
}

template <class Query>
Result<Done> TwoLevel::trace_in_waves(const Query& query) {
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        Wave<Query> wave(*this, query.part(first, count));
        std::vector<uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        wave.start(all);
        while (wave.left() > 0) {
            Result<Done> asked = Done{};
            const auto ask = [&] {
                asked = go_on(first + count - wave.left(), query.rays.size());
                return bool(asked);
            };
            if (Result<Done> done = round(~size_t(0), ask, wave); !done)
                return done;
            if (!asked)
                return asked;
        }
    }
    return Done{};
}

/// Two batches take turns: one is with the kernel, the other is settled and filled again.
template <class Query>
Result<Done> TwoLevel::trace_in_one_pass(const Query& query) {
    OnePass<Query> rays(*this, query);
    Batch* now = &batches_[0];
    Batch* other = &batches_[1];
    other->rays.clear();
    rays.begin(*now);
    size_t traced = 0;
    while (!now->rays.empty()) {
        if (Result<Done> asked = go_on(traced, query.rays.size()); !asked)
            return asked;
        const size_t begun = rays.begun();
        const Result<size_t> moved = pass(*now, {}, [&] {
            rays.settle(*other);
            rays.begin(*other);
        });
        if (!moved)
            return moved.error();
        traced = begun;
        std::swap(now, other);
    }
    rays.settle(*other);
    return Done{};
}

Result<ovc_active> TwoLevel::take_active() {
    if (!options_.tell_active)
        return Error{"which pages are active is told where ovc_scene_config.tell_active is 1"};
    if (Result<Done> ready = ready_device(); !ready)
        return ready.error();
    std::vector<uint32_t> now(pages_.size());
    gl_.run([&](GlState& state) {
        if (tracer_ && is_ours(state))
            now = tracer_->take_active();
    });
    ovc_active active{};
    was_active_.resize(pages_.size());
    for (size_t leaf = 0; leaf < now.size(); ++leaf) {
        if (now[leaf]) {
            active.pages += 1;
            active.bytes += pages_[leaf].bytes();
            active.new_pages += !was_active_[leaf];
            active.new_bytes += was_active_[leaf] ? 0 : pages_[leaf].bytes();
        }
        was_active_[leaf] = now[leaf] != 0;
    }
    return active;
}

Result<Done> TwoLevel::intersect(RaySpan rays, std::span<const TriangleId> skip,
                                 std::span<Hit> hits) {
    return trace(NearestQuery{rays, skip, hits, {}, {}});
}

Result<Done> TwoLevel::intersect_noted(RaySpan rays, std::span<const TriangleId> skip,
                                       std::span<Hit> hits, const RayNotes& notes) {
    std::fill(notes.passes.begin(), notes.passes.end(), 0);
    std::fill(notes.flagged.begin(), notes.flagged.end(), 0);
    if (Result<Done> done = trace(NearestQuery{rays, skip, hits, notes.passes, notes.flagged});
        !done)
        return done;
    parallel_for(notes.leaf.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            notes.leaf[i] =
                hits[i].is_hit() ? leaf_at(level1_, rays[i].at(hits[i].t), hits[i].id) : kNone;
    });
    return Done{};
}

Hit TwoLevel::nearest_on_cpu(const Ray& ray, TriangleId skip) const {
    return on_cpu</* kAnyHit= */ false>(ray, skip);
}

bool TwoLevel::occluded_on_cpu(const Ray& ray, TriangleId skip) const {
    return on_cpu</* kAnyHit= */ true>(ray, skip).is_hit();
}

template <bool kAnyHit>
Hit TwoLevel::on_cpu(const Ray& ray, TriangleId skip) const {
    return arbitrate<kAnyHit>(soup_, numbers_, twins_, level1_, pages_, PreparedRay(ray, skip));
}

Result<Done> TwoLevel::occluded(RaySpan rays, std::span<const TriangleId> skip,
                                std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, skip, occluded});
}

} // namespace ovc
