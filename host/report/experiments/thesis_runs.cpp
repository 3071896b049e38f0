// SPDX-License-Identifier: Apache-2.0
// Runs that repeat the figures of chapter 4 of the thesis: its scenes, its systems, its frames.
#include "host/report/experiments/experiment.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace {

/// A system that the thesis compares, or the product beside it.
struct System {
    const char* key;
    Words words;
};

const std::vector<System>& systems() {
    static const std::vector<System> all = {
        {"kdt", {"--backend", "cpu-kdtree"}},
        {"single", {"--backend", "single-texture"}},
        {"batched", {"--backend", "thesis-two-level", "--mode", "batched"}},
        {"mixed", {"--backend", "thesis-two-level", "--mode", "mixed"}},
        {"product-batched", {"--backend", "two-level", "--mode", "batched"}},
        {"product-mixed", {"--backend", "two-level", "--mode", "mixed"}}};
    return all;
}

/// Returns all frames of a path of so many in the full form, an eighth of them in the quick one.
std::string frames(const ReportPlan& plan, int count) {
    return fmt::format("0:{}:{}", count - 1, plan.quick ? 8 : 1);
}

/// Adds a run of each system, with the key KEY--SYSTEM.
void add_systems(const ReportPlan& plan, const std::string& key, const Words& picture,
                 std::span<const std::string_view> chosen, double seconds,
                 std::vector<ReportRun>& runs) {
    for (const System& system : systems()) {
        if (std::ranges::find(chosen, std::string_view(system.key)) == chosen.end())
            continue;
        Words words = with_words({"render"}, picture);
        words.insert(words.end(), {"--size", plan.quick ? "128x128" : "256x256", "--quiet",
                                   "--stats", "{}/stats.json", "-o", "{}/frame-####.png"});
        runs.push_back({fmt::format("{}--{}", key, system.key),
                        with_words(std::move(words), system.words), "stats.json", seconds});
        // Like the thesis' single texture, ours has a maximum size.
        runs.back().may_refuse = std::string_view(system.key) == "single";
    }
}

/// The options that choose the plan's scan instead of the generated model, or in the quick form a
/// sphere, whose CPU KD-tree is built in seconds.
Words model(const ReportPlan& plan, const char* quick_model) {
    if (!plan.mesh.empty() && !plan.quick)
        return {"--model", plan.mesh};
    return plan.quick ? Words{"--model", quick_model} : Words{};
}

bool is_asked(const ReportPlan& plan, std::string_view stem) {
    return plan.scenes.empty() || std::ranges::any_of(plan.scenes, [&](const std::string& scene) {
               return std::string_view(scene).starts_with(stem);
           });
}

constexpr std::string_view kAll[] = {"kdt",   "single",          "batched",
                                     "mixed", "product-batched", "product-mixed"};
constexpr std::string_view kWalked[] = {"kdt", "batched", "mixed", "product-batched",
                                        "product-mixed"};
constexpr std::string_view kLeaves[] = {"batched", "product-batched"};

void add_dragons(const ReportPlan& plan, std::vector<ReportRun>& runs) {
    for (const int n : plan.quick ? std::vector{1, 5, 11} : std::vector{1, 5, 11, 21}) {
        const std::string scene = fmt::format("dragons-{}", n);
        const Words picture =
            with_words({scene, "--frames", frames(plan, 100)}, model(plan, "sphere-5"));
        add_systems(plan, scene, picture, kAll, plan.quick ? 2 : 15 * n, runs);
        // The thesis' GPU had as much memory.
        runs.push_back(runs.back());
        runs.back().key = scene + "--product-budget";
        runs.back().words.insert(runs.back().words.end(),
                                 {"--gpu-memory", plan.quick ? "12M" : "256M"});
    }
}

void add_dragonball(const ReportPlan& plan, std::vector<ReportRun>& runs) {
    const Words scene =
        with_words({"dragonball", "--frames", frames(plan, 100)}, model(plan, "sphere-6"));
    for (const char* leaves : plan.quick ? std::vector{"2", "8", "30", "120"}
                                         : std::vector{"2", "4", "9", "20", "50", "130", "400"})
        add_systems(plan, fmt::format("dragonball-{}", leaves),
                    with_words(scene, {"--leaves", leaves}), kLeaves, plan.quick ? 1.5 : 60, runs);
}

/// A walk through a scene, and the working set of each frame, which the product alone can tell.
void add_walk(const ReportPlan& plan, const char* quick, const char* full, int count,
              std::vector<ReportRun>& runs) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0] : plan.quick ? quick : full;
    const std::string name = full;
    const Words picture = {scene, "--frames", frames(plan, count)};
    add_systems(plan, name, picture, kWalked, plan.quick ? 4 : 250, runs);
    runs.push_back(*(runs.end() - 2));
    runs.back().key = name + "--active";
    runs.back().words.push_back("--working-set");
    runs.back().timed = false;
}

struct Shot {
    const char* key;
    const char* full;  // the scene of the full form
    const char* quick; // the scene of the quick form
    const char* frame; // of the camera path; empty: the scene's own camera
    bool patches;      // leaves of level 1 instead of the picture
};

constexpr Shot kShots[] = {{"partition", "knot", "knot", "", true},
                           {"dragons", "dragons-21", "dragons-21", "8", false},
                           {"dragonball", "dragonball", "dragonball", "0", false},
                           {"plants", "plants", "plants-10", "0", false},
                           {"plants-partition", "plants", "plants-10", "0", true},
                           {"powerplant", "powerplant", "powerplant-400000", "0", false}};

ReportRun shot_run(const Shot& shot, const ReportPlan& plan, const std::string& scene) {
    ReportRun run{shot.key,
                  {"render", scene, "--size", plan.quick ? "400x400" : "640x640", "--quiet",
                   "--stats", "{}/stats.json"},
                  "stats.json",
                  plan.quick ? 2.0 : 12.0};
    run.timed = false;
    if (*shot.frame)
        run.words.insert(run.words.end(), {"--frames", shot.frame});
    if (scene.starts_with("dragons-") || scene == "dragonball")
        run.words = with_words(std::move(run.words), model(plan, "sphere-6"));
    if (shot.patches)
        run.words.insert(run.words.end(), {"--leaves", "24", "--aov", "leaf,normal"});
    run.picture =
        std::string("picture") + (*shot.frame ? "-####" : "") + (shot.patches ? ".exr" : ".png");
    run.words.insert(run.words.end(), {"-o", "{}/" + run.picture});
    if (*shot.frame) // then the picture's name has the frame's number
        run.picture.replace(run.picture.find("####"), 4, fmt::format("{:0>4}", shot.frame));
    return run;
}

} // namespace

std::vector<ReportRun> thesis_runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    if (is_asked(plan, "dragons"))
        add_dragons(plan, runs);
    if (is_asked(plan, "dragonball"))
        add_dragonball(plan, runs);
    if (is_asked(plan, "plants"))
        add_walk(plan, "plants-3", "plants", 255, runs);
    if (is_asked(plan, "powerplant"))
        add_walk(plan, "powerplant-200000", "powerplant", 275, runs);
    return runs;
}

std::vector<ReportRun> pictures_runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const Shot& shot : kShots) {
        if (plan.scenes.empty())
            runs.push_back(shot_run(shot, plan, plan.quick ? shot.quick : shot.full));
        else if (shot.patches && runs.empty())
            runs.push_back(shot_run(shot, plan, plan.scenes[0]));
    }
    return runs;
}

} // namespace ovc
