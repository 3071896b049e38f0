// SPDX-License-Identifier: Apache-2.0
#include "host/doctor/right_answers.h"

#include "host/bench/ray_sets.h"
#include "host/scene/scene_source.h"

#include <tuple>

namespace ovc {
namespace {

constexpr const char* kScenes[] = {"sphere-5", "far-terrain", "fractal-3"};
constexpr uint32_t kSide = 128; // pixels

bool same(const Hit& a, const Hit& b) {
    return std::tie(a.t, a.u, a.v, a.id) == std::tie(b.t, b.u, b.v, b.id);
}

uint64_t count_unlike(const RaySetAnswers& a, const RaySetAnswers& b) {
    uint64_t count = 0;
    for (size_t i = 0; i < a.hits.size(); ++i)
        count += !same(a.hits[i], b.hits[i]);
    for (size_t i = 0; i < a.occluded.size(); ++i)
        count += a.occluded[i] != b.occluded[i];
    return count;
}

} // namespace

Result<CheckedScene> check_answers(const Scene& scene, Backend& device, Backend& reference) {
    const Camera camera = own_or_framing_camera(scene, kSide, kSide);
    Result<std::vector<RaySet>> sets = make_ray_sets(scene, camera, kSide, kSide, reference);
    if (!sets)
        return sets.error();
    Result<RaySet> edges = make_edge_set(scene, camera, kSide, kSide, reference);
    if (!edges)
        return edges.error();
    sets->push_back(std::move(*edges));
    CheckedScene checked;
    for (const RaySet& set : *sets) {
        const Result<RaySetAnswers> right = answers_of(set, reference);
        if (!right)
            return right.error();
        const Result<RaySetAnswers> found = answers_of(set, device);
        if (!found)
            return found.error();
        checked.rays += set.rays.size();
        checked.wrong += count_unlike(*found, *right);
    }
    return checked;
}

Result<std::vector<CheckedScene>> check_device(const std::string& device) {
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    options.device = device;
    options.kernel = OVC_KERNEL_COMPUTE; // answers all batches, however small
    std::vector<CheckedScene> all;
    for (const char* name : kScenes) {
        const Result<Scene> scene = open_scene(name, LogSink());
        if (!scene)
            return scene.error();
        const auto traced = make_backend(scene->soup, options, LogSink());
        if (!traced)
            return traced.error();
        const auto reference =
            make_backend(scene->soup, {.kind = BackendKind::CpuKdTree}, LogSink());
        if (!reference)
            return reference.error();
        Result<CheckedScene> checked = check_answers(*scene, **traced, **reference);
        if (!checked)
            return checked.error();
        checked->name = name;
        all.push_back(std::move(*checked));
    }
    return all;
}

} // namespace ovc
