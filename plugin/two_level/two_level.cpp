// SPDX-License-Identifier: Apache-2.0
// TwoLevel: the work of each call before and after its rays are traced.
#include "plugin/two_level/two_level.h"

#include "core/system/stopwatch.h"
#include "plugin/build/build_scene.h"
#include "plugin/build/saved_levels.h"
#include "plugin/resolve/all_hits.h"
#include "plugin/resolve/few_rays.h"
#include "plugin/two_level/mixed_stream.h"
#include "plugin/two_level/one_pass.h"
#include "plugin/two_level/wave_round.h"

#include <algorithm>
#include <cassert>

namespace ovc {

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log, BuildProgress* progress) {
    const Result<MemoryPlan> plan = plan_memory(soup, options, gl.info());
    if (!plan)
        return plan.error();
    if (!options.store)
        if (const Result<Done> enough = check_budget(soup, options, *plan, gl.info()); !enough)
            return enough.error();
    Result<BuiltScene> scene = options.store ? open_scene(soup, options, *plan, gl.info(), log)
                                             : build_scene(soup, options, *plan, log, progress);
    if (!scene)
        return scene.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(std::move(*scene), gl, options, *plan, log));
    const Result<SharedBudget::Use> use = self->passes_.begin_use(progress);
    if (use)
        return self;
    if (use.error().kind != ErrorKind::OutOfGpuMemory || self->scene_.pages.size() > 1 ||
        options.store || options.leaf_triangles || options.leaves)
        return use.error();
    say(log, LogLevel::Warning, "cutting the scene into leaves, of which the GPU holds some");
    TwoLevelOptions cut = options;
    cut.leaf_triangles = std::max<uint64_t>(soup.triangle_count() / kDefaultLeaves, 1);
    self.reset();
    return build(soup, gl, cut, log, progress);
}

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    assert(query.results.size() == query.rays.size());
    assert(query.without.are_for(query.rays.size()));
    watch_.begin_call();
    const Result<SharedBudget::Use> use = passes_.begin_use();
    if (!use)
        return use.error();
    was_all_resident_ = passes_.all_resident();
    const bool in_one_pass = was_all_resident_ && !query.has_sieves();
    const Result<Done> done = in_one_pass ? trace_in_one_pass(tracing_, passes_, query)
                                          : trace_in_waves(tracing_, passes_, query);
    return done ? watch_.unless_cancelled() : done;
}

template <class Trace>
Result<Done> TwoLevel::counted(uint64_t& rays_of_a_kind, size_t rays, Trace&& trace) {
    const Stopwatch watch;
    Result<Done> done = trace();
    rays_of_a_kind += rays;
    statistics_.seconds_trace += watch.seconds();
    return done;
}

Result<Done> TwoLevel::intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) {
    return counted(statistics_.nearest_rays, rays.size(), [&] {
        return trace_nearest({rays, without, hits, {}, {}, {}});
    });
}

Result<Done> TwoLevel::trace_nearest(NearestQuery query) {
    std::vector<Hit> places;
    if (query.has_sieves()) {
        query.has_own_places = query.without.after.empty();
        places.assign(query.rays.size(), kBeforeAll);
        std::ranges::copy(query.without.after, places.begin());
        query.without.after = query.places = places;
    }
    return trace(query);
}

Result<Done> TwoLevel::all_hits(RaySpan rays, const Exclusions& without, const AllHits& all) {
    const auto nearest = [this](RaySpan some, const Exclusions& also, std::span<Hit> hits) {
        return trace_nearest({some, also, hits, {}, {}, {}});
    };
    watch_.begin_call();
    return counted(statistics_.nearest_rays, rays.size(),
                   [&] { return trace_all_hits(tracing_, nearest, rays, without, all); });
}

Result<Done> TwoLevel::occluded(RaySpan rays, const Exclusions& without,
                                std::span<uint8_t> occluded) {
    return counted(statistics_.occlusion_rays, rays.size(), [&]() -> Result<Done> {
        if (without.sieves.pass_all())
            return trace(OcclusionQuery{rays, without, occluded});
        // Any hit that the kernel finds may not count, and then tells nothing of those before it.
        std::vector<Hit> hits(rays.size());
        if (Result<Done> done = trace_nearest({rays, without, hits, {}, {}, {}}); !done)
            return done;
        std::ranges::transform(hits, occluded.begin(), &Hit::is_hit);
        return Done{};
    });
}

Result<Done> TwoLevel::intersect_noted(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                                       const RayNotes& notes) {
    assert(notes.leaf.empty() || notes.leaf.size() == rays.size());
    std::fill(notes.passes.begin(), notes.passes.end(), 0);
    std::fill(notes.flagged.begin(), notes.flagged.end(), 0);
    const auto nearest = [&] {
        return trace_nearest({rays, without, hits, notes.passes, notes.flagged, {}});
    };
    if (Result<Done> done = counted(statistics_.nearest_rays, rays.size(), nearest); !done)
        return done;
    parallel_for(notes.leaf.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            notes.leaf[i] =
                hits[i].is_hit() ? scene_.page_at(rays[i].at(hits[i].t), hits[i].id) : kNone;
    });
    return Done{};
}

Hit TwoLevel::nearest_on_cpu(const Ray& ray, const Exclusion& without,
                             const RaySieve& sieve) const {
    assert(ray.valid());
    Exclusion more = without;
    for (uint8_t passed_by = 0; passed_by < kMaxPassedBy; ++passed_by) {
        const Hit hit = answer_one</* kAnyHit= */ false>(scene_, ray, more);
        if (!hit.is_hit() || sieve.passes_all() || counts(scene_.soup, sieve, hit))
            return hit;
        more.after = HitPlace(hit);
        more.after.is_certain = true;
    }
    return first_counting_hit(scene_, PreparedRay(ray, more), sieve);
}

bool TwoLevel::occluded_on_cpu(const Ray& ray, const Exclusion& without,
                               const RaySieve& sieve) const {
    assert(ray.valid());
    if (!sieve.passes_all())
        return nearest_on_cpu(ray, without, sieve).is_hit();
    return answer_one</* kAnyHit= */ true>(scene_, ray, without).is_hit();
}

template <class Query>
bool TwoLevel::answer_few(const Query& query, uint64_t& invalid) const {
    const size_t count = query.rays.size();
    if (!has_cpu_tree() || !options_.certify || options_.tell_active ||
        !query.without.sieves.pass_all())
        return false;
    if (count > kMaxFewRays && (options_.kernel_alone || !was_all_resident_))
        return false;
    std::atomic<uint64_t> invalid_of_all{0};
    parallel_for(count, kRaysPerTask, [&](size_t first, size_t last) {
        for (; first < last; first += kMaxFewRays)
            invalid_of_all += answer_group(query.part(first, std::min(kMaxFewRays, last - first)));
    });
    invalid += invalid_of_all;
    return true;
}

template <class Query>
uint64_t TwoLevel::answer_group(const Query& query) const {
    ovc_statistics statistics{};
    CallWatch nobody;
    {
        Resolver resolver({scene_, options_, statistics, nobody}, query, /* are_whole= */ true,
                          /* alone= */ true);
        FewRays(scene_, resolver).answer();
    }
    return statistics.invalid_rays;
}

bool TwoLevel::intersect_few(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                             uint64_t& invalid) const {
    return answer_few(NearestQuery{rays, without, hits, {}, {}, {}}, invalid);
}

bool TwoLevel::occluded_few(RaySpan rays, const Exclusions& without, std::span<uint8_t> occluded,
                            uint64_t& invalid) const {
    return answer_few(OcclusionQuery{rays, without, occluded}, invalid);
}

Result<Done> TwoLevel::stream(StreamHost& host) {
    watch_.begin_call();
    const Result<SharedBudget::Use> use = passes_.begin_use();
    if (!use)
        return use.error();
    const Result<Done> done = trace_stream(tracing_, passes_, host);
    return done ? watch_.unless_cancelled() : done;
}

Result<ovc_active> TwoLevel::take_active() {
    if (!options_.tell_active)
        return Error{"which pages are active is told where ovc_scene_config.tell_active is 1"};
    const Result<SharedBudget::Use> use = passes_.begin_use();
    if (!use)
        return use.error();
    const std::vector<uint32_t> now = passes_.take_active();
    assert(now.size() == scene_.pages.size());
    ovc_active active{};
    was_active_.resize(now.size());
    for (size_t leaf = 0; leaf < now.size(); ++leaf) {
        if (now[leaf]) {
            const uint64_t bytes = scene_.pages[leaf].bytes();
            active.pages += 1;
            active.bytes += bytes;
            active.new_pages += !was_active_[leaf];
            active.new_bytes += was_active_[leaf] ? 0 : bytes;
        }
        was_active_[leaf] = now[leaf] != 0;
    }
    return active;
}

Result<Done> TwoLevel::save(const ByteSink& sink) const {
    // Pages name triangles by numbers, which those that are gone have had.
    if (scene_.numbers.count() != scene_.soup.triangle_count())
        return Error{
            "meshes were removed since the scene was built; one that is built anew without "
            "them can be saved",
            ErrorKind::InvalidArgument};
    if (scene_.store)
        return Error{"the scene is one that was saved", ErrorKind::InvalidArgument};
    if (!save_levels(scene_, sink))
        return Error{"saving was stopped", ErrorKind::Cancelled};
    return Done{};
}

Result<bool> TwoLevel::update(const Changes& changes, BuildProgress* progress) {
    if (scene_.store)
        return Error{"a scene whose pages lie on a disk cannot change", ErrorKind::InvalidArgument};
    const auto updated = update_scene(scene_, changes, options_, plan_, progress);
    if (!updated)
        return false;
    statistics_.updates += 1;
    statistics_.pages_refitted += updated->refitted;
    statistics_.pages_rebuilt += updated->rebuilt;
    if (const Result<Done> done = passes_.update(plan_, *updated, progress); !done)
        return done.error();
    return true;
}

Result<Done> TwoLevel::purge() {
    passes_.purge();
    return Done{};
}

} // namespace ovc
