// SPDX-License-Identifier: Apache-2.0
// overcast bench: how fast rays are answered, by the plugin certified and fast and by its peers, in
// turn on the same rays.
#include "core/stopwatch.h"
#include "host/bench/bench_arguments.h"
#include "host/bench/bench_text.h"
#include "host/camera.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/log_arguments.h"
#include "host/output.h"
#include "host/scene_source.h"
#include "host/scene_summary.h"
#include "host/terminal_line.h"
#include "kdtree/build.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <cstdio>
#include <mutex>
#include <set>
#include <thread>

namespace ovc {

namespace {

constexpr const char* kExamples = R"(Examples:
  overcast bench dragon.ply
      camera, shadow and bounced rays, and a frame: all contenders, five times in turn
  overcast bench knot plants --only certified,embree --size 512x512 --repeats 11
      two scenes; the plugin certified, by both kernels, and both modes of Embree
  overcast bench --only certified-compute --leaves 1,8,32,128
      what leaves cost: each row says its time to the first row's
  overcast bench plants --only certified --resident all,30%
      what a budget costs that holds 30 % of the pages
  overcast bench dragon.ply --json - | jq '.scenes[].measurements[] | {contender, call_seconds}'

All contenders answer the same rays with the same number of threads, and are in memory at once.
Interrupted with Ctrl-C, it prints what it has and exits with 2.)";

/// To standard error, each sentence once: every contender of the plugin opens the same device.
class QuietLog {
public:
    explicit QuietLog(LogLevel most) : log_(standard_error_log(most)) {}
    LogSink sink() {
        return [this](LogLevel level, const std::string& message) {
            const std::lock_guard lock(mutex_); // the device's thread may call
            if (said_.insert(message).second)
                log_(level, message);
        };
    }

private:
    LogSink log_;
    std::mutex mutex_;
    std::set<std::string> said_;
};

double load_average() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : 0;
}

/// The scene's own camera and lights, or those that `overcast render` would add.
Result<Camera> dress(Scene& scene, const ImageSize& size) {
    const Camera camera =
        scene.camera ? *scene.camera
                     : framing_camera(hittable_bounds(scene.soup), size.width, size.height);
    scene.lights = placed_lights(scene.lights, camera);
    const Result<Done> fine = check_camera(camera);
    return fine ? Result<Camera>(camera) : fine.error();
}

Result<std::vector<Workload>> workloads_of(const Scene& scene, const Camera& camera,
                                           const ImageSize& size, Backend& reference,
                                           const StopRequest& stop) {
    Result<std::vector<RaySet>> sets =
        make_ray_sets(scene, camera, size.width, size.height, reference);
    if (!sets)
        return sets.error();
    std::vector<Workload> workloads;
    for (RaySet& set : *sets)
        workloads.push_back(ray_workload(std::move(set)));
    workloads.push_back(frame_workload(scene, camera, size.width, size.height, stop));
    return workloads;
}

/// Fewer than asked for where it was stopped.
Result<std::vector<Entrant>> build_entrants(const BenchJob& job, ContenderBuilder& builder,
                                            const StopRequest& stop, TerminalLine& progress) {
    std::vector<Entrant> entrants;
    for (const Contender& contender : job.contenders) {
        if (stop())
            break;
        progress.show("building " + contender.label());
        Result<std::shared_ptr<Backend>> backend = builder.build(contender);
        if (!backend)
            return Error{fmt::format("{}: {}", contender.label(), backend.error().message)};
        entrants.push_back({contender, std::move(*backend)});
    }
    return entrants;
}

Result<BenchResult> bench_scene(const BenchJob& job, const std::string& source,
                                const StopRequest& stop, const LogSink& log,
                                TerminalLine& progress) {
    BenchResult result;
    result.scene = source;
    result.width = job.size.width;
    result.height = job.size.height;
    result.threads = std::thread::hardware_concurrency();
    progress.show("reading " + source);
    const Stopwatch import;
    Result<Scene> scene = open_scene(source, log);
    if (!scene)
        return scene.error();
    result.seconds_import = import.seconds();
    result.triangles = scene->soup.triangle_count();
    const Result<Camera> camera = dress(*scene, job.size);
    if (!camera)
        return Error{fmt::format("{}: {}", source, camera.error().message)};

    progress.show("building the reference");
    const Stopwatch building;
    const auto tree = std::make_shared<const KdTree>(build_kd_tree(scene->soup));
    const std::shared_ptr<Backend> reference =
        make_cpu_backend(scene->soup, tree, building.seconds());
    ContenderBuilder builder(scene->soup, reference, tree, job.device, log);
    Result<std::vector<Entrant>> entrants = build_entrants(job, builder, stop, progress);
    if (!entrants)
        return entrants.error();
    Result<std::vector<Workload>> workloads =
        workloads_of(*scene, *camera, job.size, *reference, stop);
    if (!workloads)
        return workloads.error();
    result.load_before = load_average();
    const auto observe = [&](const std::string& what) { progress.show(source + ": " + what); };
    const Result<Done> done =
        run_contenders(*entrants, *workloads, *reference, job.repeats, stop, observe, result);
    if (!done)
        return Error{fmt::format("{}: {}", source, done.error().message)};
    result.load_after = load_average();
    progress.clear();
    return result;
}

Result<Done> save(const BenchJob& job, std::span<const BenchResult> results) {
    if (job.json.empty())
        return Done{};
    if (job.json != "-")
        return save_text(bench_json(results), job.json);
    fmt::print("{}", bench_json(results));
    return Done{};
}

Result<int> bench(const BenchJob& job, LogLevel level) {
    const InterruptGuard interrupt;
    const StopRequest stop = [&] { return interrupt.interrupted(); };
    TerminalLine progress;
    QuietLog log(level);
    std::vector<BenchResult> results;
    for (const std::string& source : job.scenes) {
        if (stop())
            break;
        Result<BenchResult> result = bench_scene(job, source, stop, log.sink(), progress);
        if (!result)
            return result.error();
        if (job.json != "-")
            fmt::print("{}{}", results.empty() ? "" : "\n", bench_table(*result));
        std::fflush(stdout);
        results.push_back(std::move(*result));
    }
    if (const Result<Done> saved = save(job, results); !saved)
        return saved.error();
    for (const BenchResult& result : results)
        if (const std::string wrong = wrong_answers(result); !wrong.empty())
            return Error{wrong};
    if (!stop())
        return kExitOk;
    fmt::print(stderr, "overcast: interrupted; what was measured so far is kept\n");
    return kExitInterrupted;
}

class Bench final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Times how rays are answered: the plugin certified and fast, and its "
                        "peers.");
        words_.add_to(app);
        log_.add_to(app);
        app.footer(kExamples);
    }

    Result<int> run() override {
        const Result<LogLevel> level = log_.resolve();
        if (!level)
            return level.error();
        const Result<BenchJob> job = understand_bench(words_);
        if (!job)
            return job.error();
        return bench(*job, *level);
    }

private:
    BenchWords words_;
    LogArguments log_;
};

} // namespace

std::unique_ptr<Subcommand> make_bench() {
    return std::make_unique<Bench>();
}

} // namespace ovc
