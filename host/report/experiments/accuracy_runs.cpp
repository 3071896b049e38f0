// SPDX-License-Identifier: Apache-2.0
// Runs that measure error against time: of answers, of pictures, and on extreme cases.
#include "host/bench/contender.h"
#include "host/report/experiments/experiment.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ovc {

namespace {

namespace fs = std::filesystem;

constexpr const char* kRaySets = "primary,shadow,diffuse,edges";

std::string contenders(const std::string& ours) {
    return ours + ",cpu" + (has_embree() ? ",embree" : "");
}

/// Returns the real files of the plan's folder that are there, in the order of interest.
std::vector<std::string> real_scenes(const ReportPlan& plan) {
    std::vector<std::string> scenes;
    if (!plan.mesh.empty())
        scenes.push_back(plan.mesh);
    for (const char* name :
         {"pbrt/v3-disini/breakfast/breakfast.pbrt", "pbrt/v1-pharr/plants.pbrt"})
        if (const fs::path path = fs::path(plan.data) / name;
            !plan.data.empty() && fs::exists(path) && (!plan.quick || scenes.empty()))
            scenes.push_back(path.string());
    return scenes;
}

/// Returns the kitchen's files, which are one scene together.
Words kitchen_parts(const ReportPlan& plan) {
    const fs::path folder = fs::path(plan.data) / "meshes/kitchen-fathirmutfak";
    Words parts;
    std::error_code error;
    if (!plan.data.empty())
        for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder, error))
            if (file.path().extension() == ".obj")
                parts.push_back(file.path().string());
    std::ranges::sort(parts);
    return parts;
}

ReportRun calls_run(const std::string& key, const std::string& scene, const Words& more,
                    bool quick) {
    return {key,
            with_words({"bench", scene, "--float-rays", "--workloads", kRaySets, "--size",
                        quick ? "256x256" : "512x512", "--repeats", quick ? "5" : "9", "--json",
                        "{}/bench.json"},
                       more),
            "bench.json", quick ? 8.0 : 60.0};
}

} // namespace

std::vector<ReportRun> error_runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty()) {
        scenes = plan.quick ? Words{"powerplant-200000", "plants-1"}
                            : Words{"knot", "powerplant-400000", "plants-10", "city"};
        const std::vector<std::string> real = real_scenes(plan);
        scenes.insert(scenes.begin(), real.begin(), real.end());
    }
    const Words all = {"--only", contenders("certified,fast")};
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        runs.push_back(calls_run(fmt::format("scene-{}", runs.size() + 1), scene, all, plan.quick));
    if (const Words parts = kitchen_parts(plan); plan.scenes.empty() && !parts.empty()) {
        runs.push_back(calls_run("kitchen", "{}/kitchen.ply", all, plan.quick));
        runs.back().before =
            with_words(with_words({"convert", "--quiet"}, parts), {"{}/kitchen.ply"});
    }
    // Two of the thesis' systems build a tree by a slow and careful rule.
    runs.push_back(calls_run("systems",
                             !plan.scenes.empty() ? scenes.back()
                             : plan.quick         ? "mirrors"
                                                  : "powerplant-200000",
                             {"--only", contenders("certified-compute,fast-compute,thesis")},
                             plan.quick));
    runs.push_back({"budget",
                    {"bench",
                     !plan.scenes.empty() ? scenes[0]
                     : plan.quick         ? "plants-4"
                                          : "plants-20",
                     "--only", "certified-compute", "--resident", "all,30%", "--workloads",
                     "primary,diffuse,frame", "--size", plan.quick ? "512x512" : "1024x1024",
                     "--repeats", "5", "--json", "{}/bench.json"},
                    "bench.json",
                    plan.quick ? 8.0 : 60.0});
    return runs;
}

std::vector<ReportRun> samples_runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty())
        scenes = plan.quick ? Words{"plants-1"} : Words{"powerplant-200000", "plants-1"};
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        runs.push_back({fmt::format("scene-{}", runs.size() + 1),
                        {"bench", scene, "--pictures", "samples", "--size",
                         plan.quick ? "128x128" : "256x256", "--most", plan.quick ? "16" : "64",
                         "--repeats", plan.quick ? "1" : "3", "--json", "{}/pictures.json"},
                        "pictures.json",
                        plan.quick ? 15.0 : 300.0});
    return runs;
}

std::vector<ReportRun> tessellation_runs(const ReportPlan& plan) {
    return {{"shapes",
             {"bench", "--pictures", "tolerance", "--size", plan.quick ? "256x256" : "1024x1024",
              "--repeats", plan.quick ? "1" : "5", "--json", "{}/shapes.json"},
             "shapes.json",
             plan.quick ? 12.0 : 90.0}};
}

std::vector<ReportRun> stiff_runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const auto& [name, seconds] : {std::pair("grid", 3.0), std::pair("stability", 45.0)}) {
        Words words = {"report", "--only", name, "-o", "{}"};
        if (plan.quick)
            words.push_back("--quick");
        if (!plan.mesh.empty() && !plan.quick && std::string_view(name) == "stability")
            words.insert(words.end(), {"--data", plan.data});
        runs.push_back({name, std::move(words), name + std::string(".json"),
                        plan.quick ? seconds : 6 * seconds});
    }
    return runs;
}

std::vector<ReportRun> programs_runs(const ReportPlan& plan) {
    const std::string mesh = !plan.scenes.empty() ? plan.scenes[0]
                             : !plan.mesh.empty() ? plan.mesh
                                                  : "knot";
    std::vector<ReportRun> runs = {
        {"programs",
         {"bench", mesh, "--programs", "--size", plan.quick ? "256x256" : "512x512", "--repeats",
          "3", "--json", "{}/programs.json"},
         "programs.json",
         plan.quick ? 12.0 : 30.0}};
    if (!plan.quick) {
        runs.push_back(
            {"bars", {"bench", mesh, "--bars", "--json", "{}/bars.json"}, "bars.json", 240});
        runs.back().judges = true;
    }
    return runs;
}

} // namespace ovc
