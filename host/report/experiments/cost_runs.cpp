// SPDX-License-Identifier: Apache-2.0
// Runs that measure cost: of what a picture has no need of, as work grows, of memory, of machines.
#include "host/report/experiments/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

namespace ovc {

namespace {

namespace fs = std::filesystem;

ReportRun picture_run(std::string key, const std::string& scene, const char* size,
                      const Words& more, double seconds) {
    return {std::move(key),
            with_words({"render", scene, "--size", size, "--quiet", "--stats", "{}/stats.json",
                        "-o", "{}/picture.png"},
                       more),
            "stats.json", seconds};
}

/// A part of the work that is left out unless a picture needs it, and how it is switched.
struct Switch {
    const char* key;
    const char* scene; // a generated scene that has the attribute
    const char* file;  // one of the folder of real files; empty: none
    Words without, with;
};

const std::vector<Switch>& switches() {
    static const char* const kRoom = "pbrt/v3-disini/breakfast/breakfast.pbrt";
    static const std::vector<Switch> all = {
        {"shadows", "powerplant-200000", kRoom, {"--no-shadows"}, {}},
        {"bounces", "mirrors", kRoom, {"--max-depth", "0"}, {}},
        {"cutouts", "leaf-canopy", "", {"--no-cutouts"}, {}},
        {"proofs", "plants-1", kRoom, {"--precision", "fast"}, {}},
        {"queues", "plants-1", kRoom, {"--leaves", "1"}, {"--leaves", "30"}},
        {"working-set", "plants-1", "", {"--leaves", "30"}, {"--leaves", "30", "--working-set"}}};
    return all;
}

/// Adds both sides of a switch by turns, and of each one run of few rays with nothing compiled
/// before, whose kernels are counted.
void add_switch(const std::string& scene, const Switch& one, bool quick,
                std::vector<ReportRun>& runs) {
    const std::string stem = fs::path(scene).stem().string();
    const auto key = [&](bool with, const std::string& which) {
        return fmt::format("{}--{}-{}-{}", stem, one.key, with ? "with" : "without", which);
    };
    for (int repeat = 0; repeat < (quick ? 3 : 7); ++repeat)
        for (const bool with : {false, true})
            runs.push_back(picture_run(key(with, std::to_string(repeat)), scene,
                                       quick ? "384x384" : "1024x1024",
                                       with ? one.with : one.without, quick ? 0.6 : 1.5));
    for (const bool with : {false, true}) {
        runs.push_back(
            picture_run(key(with, "cold"), scene, "16x16", with ? one.with : one.without, 1));
        runs.back().variables = {"OVC_KERNEL_CACHE={}/kernels", "MESA_SHADER_CACHE_DIR={}/mesa"};
    }
}

} // namespace

std::vector<ReportRun> left_out_runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const Switch& one : switches()) {
        const fs::path file = fs::path(plan.data) / one.file;
        const bool has_file = !plan.data.empty() && *one.file && fs::exists(file);
        if (!plan.scenes.empty())
            for (const std::string& scene : plan.scenes)
                add_switch(scene, one, plan.quick, runs);
        else if (has_file)
            add_switch(file.string(), one, plan.quick, runs);
        if (plan.scenes.empty() && (!has_file || !plan.quick))
            add_switch(one.scene, one, plan.quick, runs);
    }
    return runs;
}

std::vector<ReportRun> growth_runs(const ReportPlan& plan) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0]
                              : plan.quick         ? "powerplant-200000"
                              : plan.mesh.empty()  ? "powerplant-1000000"
                                                   : plan.mesh;
    const auto sweep = [&](const char* over, const Words& quick, double seconds) {
        Words words = {"bench", "--sweep", over, "--json", "{}/sweep.json"};
        if (over != std::string_view("triangles") && over != std::string_view("instances"))
            words.insert(words.begin() + 1, scene);
        return ReportRun{over, with_words(std::move(words), plan.quick ? quick : Words{}),
                         "sweep.json", plan.quick ? seconds : 15 * seconds};
    };
    std::vector<ReportRun> runs = {
        sweep("rays", {"--repeats", "3", "--most", "1000000"}, 6),
        sweep("triangles", {"--repeats", "3", "--size", "256x256", "--most", "1400000"}, 6),
        sweep("instances", {"--repeats", "3", "--size", "256x256", "--most", "10000"}, 6),
        sweep("leaves", {"--repeats", "3", "--size", "256x256", "--most", "300"}, 10),
        sweep("budget", {"--repeats", "3", "--size", "256x256"}, 10)};
    const uint32_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (uint32_t threads = 1;; threads = std::min(2 * threads, cores)) {
        for (int repeat = 0; repeat < 3; ++repeat)
            runs.push_back(picture_run(fmt::format("threads-{}-{}", threads, repeat), scene,
                                       plan.quick ? "512x512" : "1024x1024",
                                       {"--threads", std::to_string(threads)}, 2));
        if (threads == cores)
            return runs;
    }
}

/// Renders a scene file within budgets of host memory from all it takes to little.
std::vector<ReportRun> memory_runs(const ReportPlan& plan) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0]
                              : plan.quick         ? "powerplant-400000"
                                                   : "powerplant-4000000";
    const int scale = plan.quick ? 1 : 10; // with the triangles
    std::vector<ReportRun> runs;
    for (const int megabytes : {0, 16, 12, 8, 6}) {
        Words budget;
        if (megabytes > 0)
            budget = {"--host-memory", fmt::format("{}M", megabytes * scale), "--gpu-memory",
                      fmt::format("{}M", 8 * scale)};
        runs.push_back(picture_run(fmt::format("host-{}", megabytes), "{}/scene.ovc",
                                   plan.quick ? "384x384" : "1024x1024", budget, 4));
        runs.back().before = {"convert", scene, "{}/scene.ovc", "--quiet", "--leaves", "60"};
        runs.back().may_refuse = true;
    }
    return runs;
}

std::vector<ReportRun> machines_runs(const ReportPlan& plan) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0] : "plants-2";
    std::vector<ReportRun> runs;
    for (int repeat = 0; repeat < (plan.quick ? 2 : 3); ++repeat)
        for (const uint32_t ranks :
             plan.quick ? std::vector{1u, 2u, 4u} : std::vector{1u, 2u, 4u, 8u}) {
            runs.push_back(picture_run(fmt::format("ranks-{}-{}", ranks, repeat), scene,
                                       plan.quick ? "320x240" : "640x480", {"--threads", "1"}, 3));
            if (ranks > 1) {
                runs.back().ranks = ranks;
                runs.back().words.insert(runs.back().words.end(), {"--ranks-own", "share"});
            }
        }
    return runs;
}

} // namespace ovc
