// SPDX-License-Identifier: Apache-2.0
// The systems that the thesis compares, as runs of `overcast render` along a camera path, and what
// their statistics say of each frame.
#pragma once

#include "host/report/experiments/experiment.h"

#include <utility>

namespace ovc {

struct ThesisSystem {
    std::string_view key;  // "mixed"
    std::string_view name; // "two-level, mixed"
    std::vector<std::string> words;
};

/// kdt, single, batched and mixed: as the thesis has them; product-batched, product-mixed, and
/// product-budget, of which a run says how many bytes.
std::span<const ThesisSystem> thesis_systems();
/// Asserts that there is one.
const ThesisSystem& thesis_system(std::string_view key);

/// gnuplot's style of its curves, the same in every plot.
int style_of(std::string_view key);

struct FramesAsked {
    std::string scene;
    std::string frames; // as --frames takes them
    std::string size;   // as --size
    std::vector<std::string> more;
};

/// Called KEY--SYSTEM. Its statistics are the result.
ReportRun frames_run(const std::string& key, const ThesisSystem& system, const FramesAsked& asked,
                     double seconds);

/// A scene's statistics --working-set, which the product alone can tell. Called KEY--active.
ReportRun working_set_run(const std::string& key, const FramesAsked& asked, double seconds);

/// What stands for the thesis' model: --model and the mesh where there is one; of the quick form a
/// sphere, so that the CPU KD-tree is built in seconds; else nothing, and the scene makes its own.
std::vector<std::string> model_words(const ReportPlan& plan, const char* quick_model);
/// A sentence on the model of a run, or nothing.
std::string model_text(const ReportRun& run);

/// What traced the runs; empty: no run with a GPU's part is there.
std::string renderer_of(std::span<const RawResult> results);
/// Sentences on figures/renderer. Of a software renderer: why a GPU's lead over the CPU cannot
/// show.
std::string renderer_text(const Json& figures);

/// What frames are compared by: seconds; where a software renderer does the GPU's part, the CPU
/// seconds of all threads, which other programs on the machine do not change.
struct FrameCost {
    const char* list; // of frames_of()
    const char* mean;
    const char* label;
};
FrameCost cost_by(const std::string& renderer);

/// "dragons-3--mixed": "dragons-3" and "mixed".
std::pair<std::string, std::string> split_run_key(const std::string& key);

/// Of a run's statistics: "key", "name", means ("mean_seconds", "mean_cpu", "mean_calls",
/// "mean_rays"), "pass_seconds", "shade_seconds" and "moved_mb" a frame, "build_seconds", and lists
/// with a value for each frame: "frame", "seconds", "cpu", "calls", "rays", "active", "incremental"
/// (shares of the bytes of all pages). What a system does not have is null.
Json frames_of(const std::string& key, const Json& stats);

/// The system's object in a list of frames_of(); null: there is none.
const Json* find_system(const Json& systems, std::string_view key);

/// systems[a].mean / systems[b].mean; null where one is not there.
Json ratio_of(const Json& systems, const char* mean, std::string_view a, std::string_view b);

/// What the thesis found, what ours does as the thesis has it, and the product.
struct Finding {
    std::string what;
    std::string reported;
    Json as_thesis, product; // numbers or null
};
Json findings_of(const std::vector<Finding>& findings);
/// figures/findings as a table.
Table findings_table(const Json& figures);

/// One curve a system over frames. quantity: of frames_of(); only systems in `keys` that have it.
Plot frames_plot(const std::string& name, const std::string& caption, const Json& systems,
                 const std::vector<std::string_view>& keys, const std::string& quantity,
                 const std::string& label);

/// Why mixed and batched stand as they do, from the systems at the pointer `at`; nothing where they
/// are not there.
Text mixed_text(const Json& figures, const std::string& at);
/// Why the CPU KD-tree and batched stand as they do.
Text kdtree_text(const Json& figures, const std::string& at);

/// A row a system: means; systems at the pointer `at`.
Table systems_table(const Json& figures, const std::string& at, const std::string& caption);

} // namespace ovc
