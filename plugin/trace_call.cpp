// SPDX-License-Identifier: Apache-2.0
// Batches of rays, and single ones, in calls that return with the answers.
#include "plugin/trace_call.h"

#include "plugin/asked_progress.h"
#include "plugin/ray_call.h"

namespace ovc {
namespace {

void trace_asked(ovc_scene scene, const RayCall& call, HostFloatMode& mode) {
    AskedProgress progress(call.query, mode);
    trace(call, committed(scene, call.name), call.query.progress ? &progress : nullptr);
}

/// Answers one ray by answer(call, ray, skip), beside other calls; `batch` does where the structure
/// has no tree on the CPU.
template <class Answer, class Batch>
ovc_result single(ovc_scene scene, const char* name, const ovc_ray* ray, const void* result,
                  const ovc_query* query, Answer&& answer, Batch&& batch) {
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
        if (on_cpu)
            answer(call, rays_of(asked, ray, 1)[0],
                   asked.skip ? skip_of(asked, 1)[0] : TriangleId{});
    });
    return on_cpu ? done : batch();
}

} // namespace

ovc_result intersect(ovc_scene scene, const ovc_ray* rays, size_t ray_count, ovc_hit* hits,
                     const ovc_query* query) {
    HostFloatMode mode;
    return on_scene(scene, "intersect", [&] {
        trace_asked(scene, nearest_call("intersect", rays, ray_count, hits, query), mode);
    });
}

ovc_result occluded(ovc_scene scene, const ovc_ray* rays, size_t ray_count, uint8_t* occluded,
                    const ovc_query* query) {
    HostFloatMode mode;
    return on_scene(scene, "occluded", [&] {
        trace_asked(scene, occlusion_call("occluded", rays, ray_count, occluded, query), mode);
    });
}

ovc_result intersect1(ovc_scene scene, const ovc_ray* ray, ovc_hit* hit, const ovc_query* query) {
    return single(
        scene, "intersect1", ray, hit, query,
        [&](SingleRays::Call& call, const Ray& asked, TriangleId skip) {
            *reinterpret_cast<Hit*>(hit) = call.nearest(asked, skip);
        },
        [&] { return intersect(scene, ray, 1, hit, query); });
}

ovc_result occluded1(ovc_scene scene, const ovc_ray* ray, uint8_t* occluded,
                     const ovc_query* query) {
    return single(
        scene, "occluded1", ray, occluded, query,
        [&](SingleRays::Call& call, const Ray& asked, TriangleId skip) {
            *occluded = call.occluded(asked, skip);
        },
        [&] { return ovc::occluded(scene, ray, 1, occluded, query); });
}

} // namespace ovc
