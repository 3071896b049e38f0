// SPDX-License-Identifier: Apache-2.0
// single_rays_cost SCENE [--threads N] [--size N] [--repeats N] measures rays asked one by one,
// from as many threads as there are cores and from many more. It compares them with the plugin's
// CPU tree in a plain loop, the CPU KD-tree, the same rays gathered for the GPU, and batches on
// either side of kMaxFewRays. All take turns; medians and the longest wait of a call are printed.
// On a machine that others use too, compare rays per second of this process' CPU time.
#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/bench/ray_sets.h"
#include "host/camera/camera.h"
#include "host/scene/scene_source.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/process_cost.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"
#include "plugin/structure/single_rays.h"
#include "plugin/two_level/two_level.h"
#include "tests/abi/abi_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace ovc {
namespace {

struct Job {
    std::string scene;
    size_t threads = 256;
    uint32_t size = 512;
    int repeats = 5;
};

struct Run {
    double seconds = 0;
    double cpu_seconds = 0;  // the sum over all threads
    double longest_wait = 0; // the longest single call, in seconds
};

// A thread of a host takes so many rays at once.
constexpr size_t kTile = 64;

/// Calls ask(first, last) for all of [0, count) on so many threads, which share the rays as
/// renderers share tiles.
template <class Ask>
Run on_threads(size_t threads, size_t count, size_t tile, Ask&& ask) {
    std::atomic<size_t> next{0};
    std::vector<double> longest(threads);
    std::barrier start(ptrdiff_t(threads + 1));
    std::vector<std::thread> running;
    for (size_t t = 0; t < threads; ++t)
        running.emplace_back([&, t] {
            start.arrive_and_wait();
            for (size_t first; (first = next.fetch_add(tile)) < count;) {
                // The time of a tile bounds its longest call.
                const Stopwatch watch;
                ask(first, std::min(first + tile, count));
                longest[t] = std::max(longest[t], watch.seconds());
            }
        });
    const double cpu_before = process_cpu_seconds();
    const Stopwatch watch;
    start.arrive_and_wait();
    for (std::thread& thread : running)
        thread.join();
    return {watch.seconds(), process_cpu_seconds() - cpu_before,
            *std::max_element(longest.begin(), longest.end())};
}

/// A way to answer a set of rays, with its times.
struct Contender {
    std::string name;
    std::function<Run(const RaySet&, std::vector<Hit>&)> run;
    std::vector<Run> runs{};
};

Run timed(const std::function<void()>& work) {
    const double cpu_before = process_cpu_seconds();
    const Stopwatch watch;
    work();
    return {watch.seconds(), process_cpu_seconds() - cpu_before, 0};
}

std::vector<Contender> contenders(const Job& job, const KdTree& tree, const Soup& soup,
                                  TwoLevel& two_level, ovc_scene scene,
                                  Gathering<SingleRay>& gathering) {
    const auto one_by_one = [scene](size_t threads) {
        return [scene, threads](const RaySet& set, std::vector<Hit>& hits) {
            return on_threads(threads, set.rays.size(), kTile, [&](size_t first, size_t last) {
                for (size_t i = first; i < last; ++i)
                    if (test::api().intersect1(
                            scene, reinterpret_cast<const ovc_ray*>(&set.rays[i]),
                            reinterpret_cast<ovc_hit*>(&hits[i]), nullptr) != OVC_OK)
                        std::abort();
            });
        };
    };
    const auto in_batches = [scene](size_t rays, size_t threads) {
        const auto run = [=](const RaySet& set, std::vector<Hit>& hits) {
            return on_threads(threads, set.rays.size(), rays, [&](size_t first, size_t last) {
                if (test::api().intersect(scene, reinterpret_cast<const ovc_ray*>(&set.rays[first]),
                                          last - first, reinterpret_cast<ovc_hit*>(&hits[first]),
                                          nullptr) != OVC_OK)
                    std::abort();
            });
        };
        return Contender{fmt::format("{} rays a call, {} threads", rays, threads), run};
    };
    return {
        {"CPU tree of the plugin, plain loop",
         [&](const RaySet& set, std::vector<Hit>& hits) {
             return timed([&] {
                 parallel_for(set.rays.size(), kTile, [&](size_t first, size_t last) {
                     for (size_t i = first; i < last; ++i)
                         hits[i] = two_level.nearest_on_cpu(set.rays[i], {}, {});
                 });
             });
         }},
        {"CPU KD-tree, plain loop",
         [&](const RaySet& set, std::vector<Hit>& hits) {
             return timed([&] { intersect(tree, soup, set.rays, {}, hits); });
         }},
        {"intersect, one batch",
         [&](const RaySet& set, std::vector<Hit>& hits) {
             return timed([&] {
                 if (!two_level.intersect(set.rays, {}, hits))
                     std::abort();
             });
         }},
        {fmt::format("intersect1, {} threads", thread_count()), one_by_one(thread_count())},
        {fmt::format("intersect1, {} threads", job.threads), one_by_one(job.threads)},
        in_batches(8, thread_count()),
        in_batches(kMaxFewRays, 1),
        in_batches(kMaxFewRays, thread_count()),
        in_batches(kMaxFewRays + 1, 1),
        in_batches(kMaxFewRays + 1, thread_count()),
        in_batches(kMaxFewRays + 1, job.threads),
        {fmt::format("gathered alone, {} threads", job.threads),
         [&](const RaySet& set, std::vector<Hit>& hits) {
             // This may be slow, so it gets a thirtieth of the rays.
             return on_threads(job.threads, set.rays.size() / 30, 1, [&](size_t i, size_t) {
                 SingleRay asked;
                 asked.ray = set.rays[i];
                 gathering.answer(asked, [&](std::span<SingleRay* const> batch) {
                     std::vector<Ray> rays;
                     for (const SingleRay* single : batch)
                         rays.push_back(single->ray);
                     std::vector<Hit> found(rays.size());
                     if (!two_level.intersect(rays, {}, found))
                         std::abort();
                     for (size_t k = 0; k < batch.size(); ++k)
                         batch[k]->hit = found[k];
                     return true;
                 });
                 hits[i] = asked.hit;
             });
         }},
    };
}

double median(std::vector<Run> runs, double Run::*what) {
    std::sort(runs.begin(), runs.end(),
              [&](const Run& a, const Run& b) { return a.*what < b.*what; });
    return runs[runs.size() / 2].*what;
}

void measure(const Job& job, const RaySet& set, std::vector<Contender> all) {
    std::vector<Hit> expected;
    for (int repeat = 0; repeat < job.repeats; ++repeat)
        for (Contender& contender : all) {
            std::vector<Hit> hits(set.rays.size());
            contender.runs.push_back(contender.run(set, hits));
            if (expected.empty())
                expected = hits;
            const size_t answered =
                contender.name.starts_with("gathered") ? hits.size() / 30 : hits.size();
            if (std::memcmp(hits.data(), expected.data(), answered * sizeof(Hit)) != 0)
                fmt::print("{}: other answers\n", contender.name);
        }
    fmt::print("{}, {} rays\n{:38}   Mrays/s   of the tree's   Mrays/CPU-s   of the tree's   "
               "slowest call or {} rays\n",
               set.name, set.rays.size(), "", kTile);
    for (const Contender& contender : all) {
        const double rays = double(set.rays.size()) *
                            (contender.name.starts_with("gathered") ? 1.0 / 30 : 1.0) / 1e6;
        const double wall = rays / median(contender.runs, &Run::seconds);
        const double cpu = rays / median(contender.runs, &Run::cpu_seconds);
        const double tree = double(set.rays.size()) / 1e6;
        fmt::print("  {:36} {:9.3f} {:15.2f} {:13.3f} {:15.2f}", contender.name, wall,
                   wall * median(all[0].runs, &Run::seconds) / tree, cpu,
                   cpu * median(all[0].runs, &Run::cpu_seconds) / tree);
        double longest = 0;
        for (const Run& r : contender.runs)
            longest = std::max(longest, r.longest_wait);
        fmt::print("{}\n", longest > 0 ? fmt::format("{:14.3f} s", longest) : std::string());
    }
}

Result<Done> run(const Job& job) {
    Result<Scene> scene = open_scene(job.scene, standard_error_log(LogLevel::Warning));
    if (!scene)
        return scene.error();
    const Camera camera = framing_camera(hittable_bounds(scene->soup), job.size, job.size);
    scene->lights = placed_lights(*scene, scene->lights, camera);
    const KdTree tree = build_kd_tree(scene->soup);
    const std::unique_ptr<Backend> reference = make_cpu_backend(scene->soup, tree, 0);
    const Result<std::vector<RaySet>> sets =
        make_ray_sets(*scene, camera, job.size, job.size, *reference);
    if (!sets)
        return sets.error();

    const Result<std::unique_ptr<GlThread>> gl = GlThread::start("", {});
    if (!gl)
        return gl.error();
    const Result<std::unique_ptr<TwoLevel>> two_level = TwoLevel::build(scene->soup, **gl, {}, {});
    if (!two_level)
        return two_level.error();
    const test::Device device = test::open_device();
    const test::AbiScene abi = test::add_soup(device, scene->soup, test::sized<ovc_scene_config>());
    if (!abi || test::api().commit(abi.get()) != OVC_OK)
        return Error{test::api().last_error(device.get())};

    Gathering<SingleRay> gathering;
    for (const RaySet& set : *sets)
        if (set.query == RayQuery::Nearest)
            measure(job, set,
                    contenders(job, tree, scene->soup, **two_level, abi.get(), gathering));
    auto statistics = test::sized<ovc_statistics>();
    test::api().statistics(abi.get(), &statistics);
    fmt::print("{} of {} single rays were gathered\n", statistics.gathered_rays,
               statistics.single_rays);
    return Done{};
}

} // namespace
} // namespace ovc

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    ovc::Job job;
    for (size_t i = 0; i < words.size(); ++i) {
        const bool has_value = i + 1 < words.size();
        if (words[i] == "--threads" && has_value)
            job.threads = size_t(std::max(1, std::atoi(words[++i].c_str())));
        else if (words[i] == "--size" && has_value)
            job.size = uint32_t(std::max(8, std::atoi(words[++i].c_str())));
        else if (words[i] == "--repeats" && has_value)
            job.repeats = std::max(1, std::atoi(words[++i].c_str()));
        else
            job.scene = words[i];
    }
    if (job.scene.empty() || job.scene.starts_with("-")) {
        fmt::print(stderr,
                   "usage: single_rays_cost SCENE [--threads N] [--size N] [--repeats N]\n");
        return 2;
    }
    const ovc::Result<ovc::Done> done = ovc::run(job);
    if (!done)
        fmt::print(stderr, "single_rays_cost: {}\n", done.error().message);
    return done ? 0 : 1;
}
