// SPDX-License-Identifier: Apache-2.0
// Makes runs of `overcast render` along a camera path for each system that the thesis compares, and
// reads the figures of each frame from their statistics.
#pragma once

#include "host/report/experiments/experiment.h"

#include <utility>

namespace ovc {

struct ThesisSystem {
    std::string_view key;  // "mixed"
    std::string_view name; // "two-level, mixed"
    std::vector<std::string> words;
};

/// Returns kdt, single, batched and mixed, as the thesis has them, and product-batched,
/// product-mixed and product-budget. A run of product-budget has to set its bytes.
std::span<const ThesisSystem> thesis_systems();
/// Returns the system with this key, which exists (asserted).
const ThesisSystem& thesis_system(std::string_view key);

/// Returns gnuplot's line style for the system's curves, the same in every plot.
int style_of(std::string_view key);

struct FramesAsked {
    std::string scene;
    std::string frames; // as --frames takes them
    std::string size;   // as --size
    std::vector<std::string> more;
};

/// Returns a run with the key KEY--SYSTEM, whose result is the statistics of `overcast render`.
ReportRun frames_run(const std::string& key, const ThesisSystem& system, const FramesAsked& asked,
                     double seconds);

/// Returns a run with the key KEY--active, whose statistics have --working-set. Only the product
/// can tell those.
ReportRun working_set_run(const std::string& key, const FramesAsked& asked, double seconds);

/// Returns the options that choose a substitute for the thesis' model: --model with the plan's mesh
/// where there is one, a sphere in the quick form, so that the CPU KD-tree is built in seconds, or
/// no options, so that the scene makes its own.
std::vector<std::string> model_words(const ReportPlan& plan, const char* quick_model);
/// Returns a sentence on the model of a run, or nothing.
std::string model_text(const ReportRun& run);

/// Returns the renderer of the runs, or "" where none of them has a GPU's part.
std::string renderer_of(std::span<const RawResult> results);
/// Returns sentences on figures/renderer. For a software renderer they say why a GPU's lead over
/// the CPU cannot show.
std::string renderer_text(const Json& figures);

/// The cost by which frames are compared: seconds, or CPU seconds of all threads where a software
/// renderer does the GPU's part, because other programs on the machine do not change these.
struct FrameCost {
    const char* list; // of frames_of()
    const char* mean;
    const char* label;
};
FrameCost cost_by(const std::string& renderer);

/// Splits "dragons-3--mixed" into "dragons-3" and "mixed". The key contains "--" (asserted).
std::pair<std::string, std::string> split_run_key(const std::string& key);

/// Reads from a run's statistics: "key", "name", means ("mean_seconds", "mean_cpu", "mean_calls",
/// "mean_rays"), "pass_seconds", "shade_seconds" and "moved_mb" a frame, "build_seconds", and lists
/// with a value for each frame: "frame", "seconds", "cpu", "calls", "rays", "active", "incremental"
/// (shares of the bytes of all pages). Values that a system does not have are null.
Json frames_of(const std::string& key, const Json& stats);

/// Returns the system's object in a list of frames_of(), or null.
const Json* find_system(const Json& systems, std::string_view key);

/// Returns systems[a].mean / systems[b].mean, or null where one is missing or the second is 0.
Json ratio_of(const Json& systems, const char* mean, std::string_view a, std::string_view b);

/// A finding of the thesis, beside the same figure of its system here and of the product.
struct Finding {
    std::string what;
    std::string reported;
    Json as_thesis, product; // numbers or null
};
Json findings_of(const std::vector<Finding>& findings);
/// Returns figures/findings as a table.
Table findings_table(const Json& figures);

/// Returns a plot with one curve over frames for each system in `keys` that has the quantity.
/// quantity: a list of frames_of().
Plot frames_plot(const std::string& name, const std::string& caption, const Json& systems,
                 const std::vector<std::string_view>& keys, const std::string& quantity,
                 const std::string& label);

/// Explains the difference between mixed and batched, from the systems at the pointer `at`; empty
/// where they are missing.
Text mixed_text(const Json& figures, const std::string& at);
/// Explains the difference between the CPU KD-tree and batched, in the same way.
Text kdtree_text(const Json& figures, const std::string& at);

/// Returns a table of means with a row for each system at the pointer `at`.
Table systems_table(const Json& figures, const std::string& at, const std::string& caption);

} // namespace ovc
