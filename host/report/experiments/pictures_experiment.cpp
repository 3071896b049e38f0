// SPDX-License-Identifier: Apache-2.0
// Draws the scenes of the thesis, the camera's path, and level 1 as patches of colour, as figures
// 3.5, 4.1, 4.2 and 4.3 of the thesis do.
#include "host/report/experiments/experiment_table.h"
#include "host/report/experiments/thesis_runs.h"
#include "testscenes/catalog.h"

#include <fmt/format.h>

namespace ovc {

namespace pictures {

struct Shot {
    const char* key;
    const char* caption;
    const char* full;  // the scene of the full form
    const char* quick; // the scene of the quick form
    const char* frame; // of the camera path; empty: the scene's own camera
    bool patches;      // leaves of level 1 instead of the picture
};

constexpr Shot kShots[] = {
    {"partition", "Figure 3.5 of the thesis, here: leaves of level 1 as patches of colour.", "knot",
     "knot", "", true},
    {"dragons", "Figure 4.1 of the thesis, here: the dragons, from above.", "dragons-21",
     "dragons-21", "8", false},
    {"dragonball", "Dragonball.", "dragonball", "dragonball", "0", false},
    {"plants", "Figure 4.3 (a) of the thesis, here: plants, from above.", "plants", "plants-10",
     "0", false},
    {"plants-partition", "Figure 4.3 (b) of the thesis, here: its leaves of level 1.", "plants",
     "plants-10", "0", true},
    {"powerplant", "Power plant, from outside.", "powerplant", "powerplant-400000", "0", false}};

constexpr const char* kPathScene = "dragons-21";

ReportRun run_of(const Shot& shot, const ReportPlan& plan, const std::string& scene) {
    ReportRun run{shot.key,
                  {"render", scene, "--size", plan.quick ? "400x400" : "640x640", "--quiet",
                   "--stats", "{}/stats.json"},
                  "stats.json",
                  plan.quick ? 3.0 : 12.0};
    if (*shot.frame)
        run.words.insert(run.words.end(), {"--frames", shot.frame});
    if (scene.starts_with("dragons-") || scene == "dragonball")
        for (std::string& word : model_words(plan, scene == "dragonball" ? "sphere-7" : "sphere-5"))
            run.words.push_back(std::move(word));
    if (shot.patches)
        run.words.insert(run.words.end(), {"--leaves", "24", "--aov", "leaf,normal"});
    run.picture =
        std::string("picture") + (*shot.frame ? "-####" : "") + (shot.patches ? ".exr" : ".png");
    run.words.insert(run.words.end(), {"-o", "{}/" + run.picture});
    if (*shot.frame) // then the picture's name has the frame's number
        run.picture.replace(run.picture.find("####"), 4, fmt::format("{:0>4}", shot.frame));
    return run;
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const Shot& shot : kShots) {
        std::string scene = plan.quick ? shot.quick : shot.full;
        if (!plan.mesh.empty() && std::string_view(shot.key) == "partition")
            scene = plan.mesh;
        if (!plan.scenes.empty()) {
            if (std::string_view(shot.key) != "partition")
                continue;
            scene = plan.scenes[0];
        }
        runs.push_back(run_of(shot, plan, scene));
    }
    return runs;
}

const Shot* shot_of(const std::string& key) {
    for (const Shot& shot : kShots)
        if (key == shot.key)
            return &shot;
    return nullptr;
}

/// Returns the camera's position for each frame of figure 4.2.
Json path_of() {
    Json path = Json::array();
    if (const Result<CameraPath> cameras = test_scene_path(kPathScene); cameras)
        for (const Camera& camera : *cameras)
            path.push_back({camera.eye.x, camera.eye.y, camera.eye.z});
    return path;
}

Json figures(std::span<const RawResult> results) {
    Json shots = Json::array();
    for (const RawResult& raw : results) {
        const std::string source = raw.result["scene"];
        shots.push_back({{"key", raw.run.key},
                         {"scene", source.substr(source.find_last_of('/') + 1)},
                         {"file", raw.picture},
                         {"triangles", raw.result["triangles"]},
                         {"leaves", raw.result["leaves"]},
                         {"model", model_text(raw.run)}});
    }
    return {{"shots", shots}, {"path", path_of()}};
}

Plot path_plot(const Json& figures) {
    std::string data = "# x, z, y of the camera\n";
    for (const Json& eye : figures["path"])
        data += fmt::format("{:.6g} {:.6g} {:.6g}\n", eye[0].get<double>(), eye[2].get<double>(),
                            eye[1].get<double>());
    return {"pictures-path", "Figure 4.2 of the thesis, here: where the camera goes round dragons.",
            data,
            "unset key\nset xlabel 'x'\nset ylabel 'z'\nset zlabel 'y'\nset xyplane at 0\n"
            "set border 31\nset view 60,30\n"
            "splot datafile using 1:2:3 with linespoints ls 1 ps 0.4\n"};
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks;
    blocks.emplace_back(Text{"Leaves of the upper level are what is moved into the GPU's memory "
                             "and out of it. Each has a "
                             "colour of its own where the camera sees what is in it."});
    Table table{"The pictures", {"picture", "scene", "triangles", "leaves of level 1"}, {}};
    for (size_t i = 0; i < figures["shots"].size(); ++i) {
        const Json& one = figures["shots"][i];
        const Shot* shot = shot_of(one["key"]);
        if (!shot)
            continue;
        blocks.emplace_back(
            PagePicture{one["file"], shot->caption + one["model"].get<std::string>()});
        const std::string at = fmt::format("/shots/{}", i);
        table.rows.push_back({{one["key"].get<std::string>()},
                              {one["scene"].get<std::string>()},
                              {number(figures, at + "/triangles")},
                              {number(figures, at + "/leaves")}});
    }
    blocks.emplace_back(path_plot(figures));
    blocks.emplace_back(std::move(table));
    return blocks;
}

} // namespace pictures

Experiment pictures_experiment() {
    return {"pictures",
            "The thesis: pictures",
            "figures 3.5, 4.1, 4.2 and 4.3 of the thesis: its scenes, and level 1 in colours",
            pictures::runs,
            pictures::figures,
            pictures::blocks};
}

} // namespace ovc
