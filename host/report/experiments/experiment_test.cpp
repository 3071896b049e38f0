// SPDX-License-Identifier: Apache-2.0
// Tests what experiments would run, without running it.
#include "host/report/experiments/experiment.h"

#include "testscenes/catalog.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace ovc {
namespace {

/// Returns the scene that the words ask for; empty where they ask for none, or for a file that the
/// run makes.
std::string scene_of(const Words& words) {
    const bool has_scene =
        words.size() > 1 && (words[0] == "bench" || words[0] == "render" || words[0] == "convert");
    return has_scene && !words[1].starts_with("-") && !words[1].starts_with("{}") ? words[1] : "";
}

TEST(Experiments, RunScenesThatAreThereUnderKeysOfTheirOwn) {
    for (const bool quick : {false, true})
        for (const Experiment& experiment : experiments()) {
            std::set<std::string> keys;
            for (const ReportRun& run : experiment.runs({quick, "", "", {}, ""})) {
                EXPECT_TRUE(keys.insert(run.key).second) << experiment.name << ": " << run.key;
                for (const Words& words : {run.words, run.before})
                    if (const std::string scene = scene_of(words); !scene.empty()) {
                        EXPECT_TRUE(is_test_scene(scene)) << experiment.name << ": " << scene;
                        const Result<CameraPath> path = test_scene_path(scene);
                        EXPECT_TRUE(path ||
                                    path.error().message.find("must be from") == std::string::npos)
                            << path.error().message;
                    }
                EXPECT_TRUE(std::ranges::any_of(run.words,
                                                [&](const std::string& word) {
                                                    return word == "{}/" + run.result ||
                                                           word == "{}";
                                                }))
                    << experiment.name << ", " << run.key << " writes no " << run.result;
            }
            EXPECT_FALSE(keys.empty()) << experiment.name;
        }
}

/// The thesis' figures have its numbers of frames, or an eighth of them.
TEST(Experiments, DrawAllFramesOfTheThesisOrAnEighth) {
    for (const auto& [quick, frames] : {std::pair(false, "0:274:1"), std::pair(true, "0:274:8")}) {
        const std::vector<ReportRun> runs = thesis_runs({quick, "", "", {}, ""});
        EXPECT_TRUE(std::ranges::any_of(runs, [&](const ReportRun& run) {
            return std::ranges::find(run.words, frames) != run.words.end();
        }));
    }
}

} // namespace
} // namespace ovc
