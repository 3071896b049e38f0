// SPDX-License-Identifier: Apache-2.0
// Runs the bench of one scene, from the scene's name to the times of all contenders.
#include "host/bench/scene_bench.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/bench/ray_sets.h"
#include "host/camera/camera.h"
#include "host/doctor/machine_load.h"
#include "host/ranks/shared_calls.h"
#include "host/scene/scene_source.h"
#include "host/shade/shade.h"
#include "host/terminal/terminal_line.h"
#include "kdtree/build.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace {

/// Returns the scene's own camera, or the one that `overcast render` would place, and gives the
/// scene the lights that `overcast render` would use. Error: the camera cannot be used.
Result<Camera> dress(Scene& scene, const ImageSize& size) {
    const Camera camera = own_or_framing_camera(scene, size.width, size.height);
    scene.lights = placed_lights(scene, scene.lights, camera);
    const Result<Done> fine = check_camera(camera);
    return fine ? Result<Camera>(camera) : fine.error();
}

Result<std::vector<Workload>> workloads_of(const Scene& scene, const Camera& camera,
                                           const Asked& asked, Backend& reference,
                                           const StopRequest& stop) {
    std::vector<Workload> workloads;
    const auto [width, height] = asked.size;
    const auto named = [&](const std::string& name) {
        return std::ranges::find(asked.only, name) != asked.only.end();
    };
    if (asked.ray_sets) {
        Result<std::vector<RaySet>> sets = make_ray_sets(scene, camera, width, height, reference);
        if (!sets)
            return sets.error();
        for (RaySet& set : *sets) {
            workloads.push_back(ray_workload(std::move(set)));
            if (named(workloads.back().name + kSmall))
                workloads.push_back(in_small_calls(workloads.back()));
        }
    }
    if (named("edges")) {
        Result<RaySet> edges = make_edge_set(scene, camera, width, height, reference);
        if (!edges)
            return edges.error();
        workloads.push_back(ray_workload(std::move(*edges)));
    }
    for (const uint32_t side : asked.primary_sides)
        workloads.push_back(ray_workload(make_primary_set(camera, side, side)));
    if (asked.frame)
        workloads.push_back(frame_workload(scene, camera, width, height, stop));
    if (asked.float_rays)
        for (Workload& workload : workloads)
            round_rays(workload);
    if (!asked.only.empty())
        std::erase_if(workloads, [&](const Workload& workload) { return !named(workload.name); });
    return workloads;
}

/// Returns the contenders, built; fewer than asked for where the run was stopped.
Result<std::vector<Entrant>> build_entrants(const SceneBench& job, ContenderBuilder& builder,
                                            const BenchSurroundings& around) {
    std::vector<Entrant> entrants;
    for (const Contender& contender : job.contenders) {
        if (around.stop())
            break;
        around.progress.show(fmt::format("{}: building {}", job.scene, contender.label()));
        Result<std::unique_ptr<Backend>> backend = builder.build(contender);
        if (!backend)
            return Error{fmt::format("{}: {}", contender.label(), backend.error().message)};
        entrants.push_back({contender, std::move(*backend)});
    }
    return entrants;
}

/// The CPU KDT and its tree; both null where the first contender is the reference.
struct Reference {
    std::unique_ptr<const KdTree> tree;
    double tree_seconds = 0;
    std::unique_ptr<Backend> backend; // over the tree
};

Reference make_reference(const SceneBench& job, const Soup& soup, const BenchSurroundings& around) {
    if (job.first_is_reference || job.host_bytes > 0)
        return {};
    if (soup.triangle_count() > kMaxCpuTreeTriangles) {
        say(around.log, LogLevel::Warning,
            fmt::format("{} has too many triangles for the CPU KDT, {} with those that are placed "
                        "again; the first contender is the reference",
                        job.scene, soup.triangle_count()));
        return {};
    }
    around.progress.show(job.scene + ": building the reference");
    const Stopwatch building;
    Reference reference;
    reference.tree = std::make_unique<const KdTree>(build_kd_tree(soup));
    reference.tree_seconds = building.seconds();
    reference.backend = make_cpu_backend(soup, *reference.tree, reference.tree_seconds);
    return reference;
}

/// Builds the contenders that rank 0 builds, in the same order, and answers for them.
Result<Done> serve_bench(const SceneBench& job, const Scene& scene,
                         const BenchSurroundings& around) {
    ContenderBuilder builder(scene.soup, nullptr, 0, job.device, around.log);
    builder.set_ranks_own(job.ranks_own);
    std::vector<std::unique_ptr<Backend>> backends;
    for (const Contender& contender : job.contenders) {
        Result<std::unique_ptr<Backend>> backend =
            contender.on_gpu() ? builder.build(contender) : std::unique_ptr<Backend>();
        if (!backend)
            return backend.error();
        backends.push_back(std::move(*backend));
    }
    return serve_calls(*Ranks::of_run(), backends);
}

/// Builds the reference and the contenders over the scene and runs them.
Result<Done> bench_soup(const SceneBench& job, const Scene& scene, const Camera& camera,
                        const BenchSurroundings& around, BenchResult& result) {
    const Reference reference = make_reference(job, scene.soup, around);
    ContenderBuilder builder(scene.soup, reference.tree.get(), reference.tree_seconds, job.device,
                             around.log);
    builder.set_ranks_own(job.ranks_own);
    if (scene.on_disk)
        builder.read_from(*scene.on_disk, job.contenders.size());
    Result<std::vector<Entrant>> entrants = build_entrants(job, builder, around);
    if (!entrants)
        return entrants.error();
    if (entrants->empty())
        return Done{}; // it was stopped
    const Ranks* const ranks = Ranks::of_run();
    for (size_t i = 0; ranks && i < entrants->size(); ++i)
        if (Entrant& entrant = (*entrants)[i]; entrant.contender.on_gpu())
            entrant.backend = make_shared_backend(*ranks, std::move(entrant.backend), uint32_t(i));
    Backend& judge = reference.backend ? *reference.backend : *entrants->front().backend;
    Result<std::vector<Workload>> workloads =
        workloads_of(scene, camera, job.asked, judge, around.stop);
    if (!workloads)
        return workloads.error();
    result.load_before = load_average();
    const auto observe = [&](const std::string& what) {
        around.progress.show(fmt::format("{}: {}", job.scene, what));
    };
    const Result<Done> done = run_contenders(*entrants, *workloads, scene.soup, judge, job.repeats,
                                             around.stop, observe, result);
    result.load_after = load_average();
    Ranks::fail_all_unless(done);
    if (!done)
        return scene.on_disk ? scene.on_disk->checked(done) : done;
    return ranks ? end_calls(*ranks) : done;
}

} // namespace

Result<BenchResult> bench_scene(const SceneBench& job, const BenchSurroundings& around) {
    BenchResult result;
    result.scene = job.scene;
    result.width = job.asked.size.width;
    result.height = job.asked.size.height;
    result.threads = uint32_t(thread_count());
    around.progress.show("reading " + job.scene);
    const Stopwatch import;
    ImportOptions options{around.log};
    options.host_bytes = job.host_bytes;
    Result<Scene> scene = open_scene(job.scene, options, job.model);
    if (!scene)
        return scene.error();
    result.seconds_import = import.seconds();
    result.triangles = scene->soup.triangle_count();
    const Result<Camera> camera = dress(*scene, job.asked.size);
    const Ranks* const ranks = Ranks::of_run();
    if (ranks && !ranks->is_first()) {
        const Result<Done> served = serve_bench(job, *scene, around);
        return served ? Result<BenchResult>(std::move(result)) : served.error();
    }
    const Result<Done> done =
        camera ? bench_soup(job, *scene, *camera, around, result) : camera.error();
    if (!done)
        return Error{fmt::format("{}: {}", job.scene, done.error().message)};
    around.progress.clear();
    return result;
}

} // namespace ovc
