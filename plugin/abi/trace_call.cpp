// SPDX-License-Identifier: Apache-2.0
// Calls that return with the answers: batches of rays and single rays.
#include "plugin/abi/trace_call.h"

#include "plugin/abi/asked_progress.h"
#include "plugin/abi/ray_call.h"
#include "plugin/structure/in_stream.h"
#include "plugin/structure/joined_rays.h"

#include <exception>

namespace ovc {
namespace {

// Calls of more rays fill a pass of the kernel alone.
constexpr size_t kMaxJoinedRays = 4096;

/// Whether another thread, or another way, may answer the call: nobody is asked or told anything
/// meanwhile. A thread inside the scene's own stream must be refused, so its calls are not.
bool is_plain(ovc_scene scene, const RayCall& call) {
    const ovc_query& query = call.query;
    return !call.max_hits && !query.filter && !query.progress &&
           !notes_of(query, call.rays.size()).any() &&
           scene->streaming != std::this_thread::get_id();
}

/// Answers a small batch on the CPU, beside other calls. Returns false where the kernel is to
/// answer it.
bool answer_few(ovc_scene scene, const RayCall& call) {
    SingleRays::Call few(scene->single_rays);
    std::vector<Hit> after;
    const Exclusions without = exclusions_of(call, after);
    return call.any_hit ? few.occluded(call.rays, without, call.occluded)
                        : few.nearest(call.rays, without, call.hits);
}

/// Whether the call may be one of several in a pass, for which its thread may wait. In certified
/// precision it makes no difference which rays share it.
bool may_join(ovc_scene scene, const RayCall& call) {
    return call.rays.size() <= kMaxJoinedRays && !in_stream && is_plain(scene, call) &&
           !call.query.masks && scene->config.precision == OVC_PRECISION_CERTIFIED;
}

/// Answers those of the calls that ask for any hit, or those that ask for the nearest, at once.
void trace_joined(std::span<const RayCall* const> all, bool any_hit, Structure& structure) {
    std::vector<const RayCall*> calls;
    std::vector<size_t> first{0};
    for (const RayCall* call : all)
        if (call->any_hit == any_hit) {
            check_structure(call->name, call->query, structure);
            calls.push_back(call);
            first.push_back(first.back() + call->rays.size());
        }
    if (calls.empty())
        return;
    const auto for_each_call = [&](auto&& body) {
        parallel_for(calls.size(), 1, [&](size_t from, size_t to) {
            for (size_t k = from; k < to; ++k)
                body(*calls[k], first[k]);
        });
    };
    JoinedRays joined(first.back());
    for_each_call([&](const RayCall& call, size_t at) {
        const Exclusions without = exclusions_of(call.query, call.rays.size());
        for (size_t i = 0; i < call.rays.size(); ++i)
            joined.set(at + i, call.rays[i], without[i]);
    });
    std::vector<Hit> hits(any_hit ? 0 : first.back());
    std::vector<uint8_t> occluded(any_hit ? first.back() : 0);
    const CallWatch::Scope unwatched(structure.call_watch(), nullptr);
    check(any_hit ? structure.occluded(joined.rays(), joined.without(), occluded)
                  : structure.intersect(joined.rays(), joined.without(), hits));
    for_each_call([&](const RayCall& call, size_t at) {
        if (any_hit)
            std::copy_n(&occluded[at], call.rays.size(), call.occluded.begin());
        else
            std::copy_n(&hits[at], call.rays.size(), call.hits.begin());
    });
}

/// Traces a batch together with those that other threads ask about meanwhile. Returns false where
/// that has failed, and each is to be traced alone. Throws what the call alone would throw.
bool trace_with_others(ovc_scene scene, const RayCall& call) {
    std::exception_ptr failure;
    const bool traced = scene->batches.answer(call, [&](std::span<const RayCall* const> calls) {
        try {
            in_turn(
                scene, call.name, [] { return true; },
                [&] {
                    Structure& structure = committed(scene, call.name);
                    if (calls.size() == 1)
                        return trace(call, structure, nullptr);
                    trace_joined(calls, /* any_hit= */ false, structure);
                    trace_joined(calls, /* any_hit= */ true, structure);
                });
        } catch (...) {
            if (calls.size() > 1)
                return false;
            failure = std::current_exception();
        }
        return true;
    });
    if (failure)
        std::rethrow_exception(failure);
    return traced;
}

/// Traces a batch in the scene's turn. mode: the caller's.
void trace_alone(ovc_scene scene, const RayCall& call, HostFloatMode& mode) {
    AskedProgress progress(call.query, mode);
    TraceWatch* const watch = call.query.progress ? &progress : nullptr;
    in_turn(
        scene, call.name, [&] { return progress.goes_on(0); },
        [&] { trace(call, committed(scene, call.name), watch); });
}

/// Answers a small batch on the CPU or by_kernel(), whichever was faster lately. Occlusion is
/// always the kernel's (docs/decisions/0040).
template <class ByKernel>
void by_faster_way(ovc_scene scene, const RayCall& call, ByKernel&& by_kernel) {
    if (call.any_hit)
        return by_kernel();
    const FasterByTurns::Batch batch(scene->ways_of_batches, call.rays.size());
    if (batch.way() == 0 || !answer_few(scene, call))
        by_kernel();
}

/// Traces a batch, in the scene's turn unless it is small. make_call() checks the arguments, which
/// needs no turn.
template <class MakeCall>
ovc_result batch_of_rays(ovc_scene scene, const char* name, MakeCall&& make_call) {
    HostFloatMode mode;
    return beside_scene(scene, name, [&] {
        const RayCall call = make_call();
        if (call.rays.size() <= kMaxFewRays && is_plain(scene, call) && answer_few(scene, call))
            return;
        if (!may_join(scene, call))
            return trace_alone(scene, call, mode);
        by_faster_way(scene, call, [&] {
            if (!trace_with_others(scene, call))
                trace_alone(scene, call, mode);
        });
    });
}

/// Answers one ray beside other calls; where the structure has no tree on the CPU, batch() does.
template <class Batch>
ovc_result single(ovc_scene scene, const char* name, const ovc_ray* ray, const void* result,
                  const ovc_query* query, SingleRay& single, Batch&& batch) {
    bool on_cpu = true;
    const ovc_result done = beside_scene(scene, name, [&] {
        check_buffers(name, ray, result, 1);
        const ovc_query asked = complete(query);
        refuse_notes(name, asked);
        refuse_progress(name, asked);
        SingleRays::Call call(scene->single_rays);
        if (!call.structure())
            not_committed(name);
        on_cpu = call.structure()->has_cpu_tree();
        if (!on_cpu)
            return;
        single.ray = rays_of(asked, ray, 1)[0];
        const FilterOf filter(asked);
        Exclusions without = exclusions_of(asked, 1);
        without.sieves.filters = filter.get();
        single.without = without[0];
        single.sieve = without.sieves[0];
        call.answer(single);
        filter.check(name);
    });
    return on_cpu ? done : batch();
}

} // namespace

ovc_result intersect(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits,
                     const ovc_query* query) {
    return batch_of_rays(scene, "intersect",
                         [&] { return nearest_call("intersect", rays, ray_count, hits, query); });
}

ovc_result occluded(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint8_t* occluded,
                    const ovc_query* query) {
    return batch_of_rays(scene, "occluded", [&] {
        return occlusion_call("occluded", rays, ray_count, occluded, query);
    });
}

ovc_result all_hits(ovc_scene scene, const ovc_ray* rays, size_t ray_count, size_t max_hits,
                    ovc_hit* hits, uint64_t* counts, const ovc_query* query) {
    return batch_of_rays(scene, "all_hits", [&] {
        return all_hits_call(rays, ray_count, max_hits, hits, counts, query);
    });
}

ovc_result intersect1(ovc_scene scene, const ovc_ray* ray, ovc_hit* hit, const ovc_query* query) {
    SingleRay asked;
    const ovc_result done = single(scene, "intersect1", ray, hit, query, asked, [&] {
        return intersect(scene, ray, 1, reinterpret_cast<ovc_hit*>(&asked.hit), query);
    });
    if (done == OVC_OK)
        *reinterpret_cast<Hit*>(hit) = asked.hit;
    return done;
}

ovc_result occluded1(ovc_scene scene, const ovc_ray* ray, uint8_t* occluded,
                     const ovc_query* query) {
    SingleRay asked{.any_hit = true};
    const ovc_result done = single(scene, "occluded1", ray, occluded, query, asked, [&] {
        uint8_t answer = 0;
        const ovc_result traced = ovc::occluded(scene, ray, 1, &answer, query);
        asked.occluded = answer != 0;
        return traced;
    });
    if (done == OVC_OK)
        *occluded = asked.occluded;
    return done;
}

} // namespace ovc
