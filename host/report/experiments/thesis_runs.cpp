// SPDX-License-Identifier: Apache-2.0
// Turns frames of the thesis' scenes into figures, tables and plots.
#include "host/report/experiments/thesis_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <optional>
#include <tuple>

namespace ovc {

static constexpr std::string_view kBetween = "--";

std::span<const ThesisSystem> thesis_systems() {
    static const std::vector<ThesisSystem> systems = {
        {"kdt", "CPU KD-tree", {"--backend", "cpu-kdtree"}},
        {"single", "single texture", {"--backend", "single-texture"}},
        {"batched", "two-level, batched", {"--backend", "thesis-two-level", "--mode", "batched"}},
        {"mixed", "two-level, mixed", {"--backend", "thesis-two-level", "--mode", "mixed"}},
        {"product-batched",
         "the product, batched",
         {"--backend", "two-level", "--mode", "batched"}},
        {"product-mixed", "the product, mixed", {"--backend", "two-level", "--mode", "mixed"}},
        {"product-budget", "the product, budget", {"--backend", "two-level", "--mode", "batched"}}};
    return systems;
}

const ThesisSystem& thesis_system(std::string_view key) {
    const auto found = std::ranges::find(thesis_systems(), key, &ThesisSystem::key);
    assert(found != thesis_systems().end());
    return *found;
}

int style_of(std::string_view key) {
    const auto found = std::ranges::find(thesis_systems(), key, &ThesisSystem::key);
    return found == thesis_systems().end() ? 1 : int(found - thesis_systems().begin()) + 1;
}

ReportRun frames_run(const std::string& key, const ThesisSystem& system, const FramesAsked& asked,
                     double seconds) {
    ReportRun run{fmt::format("{}{}{}", key, kBetween, system.key),
                  {"render", asked.scene, "--frames", asked.frames, "--size", asked.size},
                  "stats.json",
                  seconds};
    run.words.insert(run.words.end(), system.words.begin(), system.words.end());
    run.words.insert(run.words.end(), asked.more.begin(), asked.more.end());
    run.words.insert(run.words.end(),
                     {"--quiet", "--stats", "{}/stats.json", "-o", "{}/frame-####.png"});
    return run;
}

ReportRun working_set_run(const std::string& key, const FramesAsked& asked, double seconds) {
    FramesAsked told = asked;
    told.more.push_back("--working-set");
    ReportRun run = frames_run(key, thesis_system("product-batched"), told, seconds);
    run.key = fmt::format("{}{}active", key, kBetween);
    return run;
}

std::vector<std::string> model_words(const ReportPlan& plan, const char* quick_model) {
    if (!plan.mesh.empty())
        return {"--model", plan.mesh};
    return plan.quick ? std::vector<std::string>{"--model", quick_model}
                      : std::vector<std::string>();
}

std::string model_text(const ReportRun& run) {
    const auto found = std::ranges::find(run.words, "--model");
    return found == run.words.end()
               ? ""
               : fmt::format(" In the place of the dragon stands {}.",
                             std::filesystem::path(*(found + 1)).filename().string());
}

std::string renderer_of(std::span<const RawResult> results) {
    for (const RawResult& raw : results)
        if (split_run_key(raw.run.key).second != "kdt" && raw.result.contains("renderer"))
            return raw.result["renderer"];
    return "";
}

static bool is_software(const std::string& renderer) {
    return renderer.starts_with("llvmpipe");
}

std::string renderer_text(const Json& figures) {
    const std::string renderer = figures["renderer"];
    if (renderer.empty())
        return "";
    return "The GPU's part was done by " + renderer +
           (is_software(renderer)
                ? ": a software renderer on the cores that the CPU KD-tree has as well, so that no "
                  "GPU's lead over it can show here. Calls, rays and bytes are what they would be "
                  "on a GPU. Frames are compared by the CPU seconds of all threads while rays are "
                  "traced and shaded: other programs on the machine do not change them."
                : ".");
}

FrameCost cost_by(const std::string& renderer) {
    return is_software(renderer) ? FrameCost{"cpu", "mean_cpu", "CPU s a frame"}
                                 : FrameCost{"seconds", "mean_seconds", "s a frame"};
}

std::pair<std::string, std::string> split_run_key(const std::string& key) {
    const size_t at = key.rfind(kBetween);
    assert(at != std::string::npos);
    return {key.substr(0, at), key.substr(at + kBetween.size())};
}

static Json mean_of(const Json& list) {
    double sum = 0;
    for (const Json& value : list) {
        if (value.is_null())
            return nullptr;
        sum += value.get<double>();
    }
    return list.empty() ? Json(nullptr) : Json(sum / double(list.size()));
}

static Json share_of(const Json& frame, const char* bytes, const Json& stats) {
    const double all = stats["level2_bytes"];
    return frame["active"].is_null() || all == 0 ? Json(nullptr)
                                                 : Json(frame["active"][bytes].get<double>() / all);
}

static double rays_of(const Json& rays) {
    double sum = 0;
    for (const Json& of_a_kind : rays)
        sum += of_a_kind.get<double>();
    return sum;
}

Json frames_of(const std::string& key, const Json& stats) {
    const auto known = std::ranges::find(thesis_systems(), key, &ThesisSystem::key);
    Json of = {{"key", key},
               {"name", known == thesis_systems().end() ? key : std::string(known->name)}};
    for (const char* list : {"frame", "seconds", "cpu", "calls", "rays", "active", "incremental"})
        of[list] = Json::array();
    for (const Json& frame : stats["frames"]) {
        of["frame"].push_back(frame["frame"]);
        of["seconds"].push_back(frame["time"]["render"]);
        of["cpu"].push_back(frame["time"]["cpu"]);
        of["calls"].push_back(key == "kdt" ? Json(nullptr) : frame["passes"]);
        of["rays"].push_back(rays_of(frame["rays"]));
        of["active"].push_back(share_of(frame, "bytes", stats));
        of["incremental"].push_back(share_of(frame, "new_bytes", stats));
    }
    for (const char* list : {"seconds", "cpu", "calls", "rays"})
        of[std::string("mean_") + list] = mean_of(of[list]);
    const Json& time = stats["time"];
    of["build_seconds"] = time["level1"].get<double>() + time["level2"].get<double>();
    const double frames = double(stats["frames"].size());
    of["pass_seconds"] = time["pass"].get<double>() / frames;
    of["shade_seconds"] = time["shade"].get<double>() / frames;
    of["moved_mb"] = 1e-6 * stats["bytes_in"].get<double>() / frames;
    return of;
}

const Json* find_system(const Json& systems, std::string_view key) {
    for (const Json& one : systems)
        if (one["key"] == key)
            return &one;
    return nullptr;
}

Json ratio_of(const Json& systems, const char* mean, std::string_view a, std::string_view b) {
    const Json *over = find_system(systems, a), *under = find_system(systems, b);
    if (!over || !under || (*over)[mean].is_null() || (*under)[mean].is_null() ||
        (*under)[mean].get<double>() == 0)
        return nullptr;
    return (*over)[mean].get<double>() / (*under)[mean].get<double>();
}

Json findings_of(const std::vector<Finding>& findings) {
    Json list = Json::array();
    for (const Finding& one : findings)
        list.push_back({{"what", one.what},
                        {"reported", one.reported},
                        {"as_thesis", one.as_thesis},
                        {"product", one.product}});
    return list;
}

Table findings_table(const Json& figures) {
    Table table;
    table.caption = "What the thesis says of its curves, and what is measured here";
    table.header = {"", "the thesis reports", "its system, here", "the product"};
    for (size_t i = 0; i < figures["findings"].size(); ++i) {
        const std::string at = fmt::format("/findings/{}", i);
        const Json& one = figures["findings"][i];
        table.rows.push_back({{one["what"].get<std::string>()},
                              {one["reported"].get<std::string>()},
                              {number(figures, at + "/as_thesis")},
                              {number(figures, at + "/product")}});
    }
    return table;
}

/// Returns a cell of a data file; gnuplot leaves out NaN.
static std::string cell(const Json& value) {
    return value.is_null() ? " NaN" : fmt::format(" {:.6g}", value.get<double>());
}

static bool has(const Json& list) {
    return std::ranges::any_of(list, [](const Json& value) { return !value.is_null(); });
}

Plot frames_plot(const std::string& name, const std::string& caption, const Json& systems,
                 const std::vector<std::string_view>& keys, const std::string& quantity,
                 const std::string& label) {
    std::string data, curves;
    int block = 0;
    for (const std::string_view key : keys) {
        const Json* one = find_system(systems, key);
        if (!one || !has((*one)[quantity]))
            continue;
        data += fmt::format("# {}: frame, {}\n", (*one)["name"].get<std::string>(), quantity);
        for (size_t i = 0; i < (*one)["frame"].size(); ++i)
            data += fmt::format("{}{}\n", (*one)["frame"][i].get<int>(), cell((*one)[quantity][i]));
        data += "\n\n";
        curves +=
            fmt::format("{}datafile index {} using 1:2 with linespoints ls {} title '{}'",
                        block ? ", " : "", block, style_of(key), (*one)["name"].get<std::string>());
        ++block;
    }
    return {name, caption, data,
            fmt::format("set xlabel 'frame'\nset ylabel '{}'\nset yrange [0:*]\nplot {}\n", label,
                        curves)};
}

/// Returns the pointer to the system's object, or nothing where there is none.
static std::optional<std::string> pointer_to(const Json& figures, const std::string& at,
                                             std::string_view key) {
    const Json& systems = figures.at(Json::json_pointer(at));
    for (size_t i = 0; i < systems.size(); ++i)
        if (systems[i]["key"] == key)
            return fmt::format("{}/{}", at, i);
    return {};
}

Text mixed_text(const Json& figures, const std::string& at) {
    Text text;
    for (const auto& [batched_key, mixed_key, whose] :
         {std::tuple("batched", "mixed", "the thesis' system"),
          std::tuple("product-batched", "product-mixed", "the product")}) {
        const auto batched = pointer_to(figures, at, batched_key),
                   mixed = pointer_to(figures, at, mixed_key);
        if (!batched || !mixed)
            continue;
        const auto both = [&](const char* what, const char* of) {
            for (Piece piece : {Piece(what), number(figures, *mixed + of), Piece(" instead of "),
                                number(figures, *batched + of)})
                text.push_back(std::move(piece));
        };
        text.push_back(
            fmt::format("{}Mixed against batched, {}, a frame: ", text.empty() ? "" : " ", whose));
        both("", "/mean_calls");
        both(" GPU calls; ", "/pass_seconds");
        both(" s in passes; ", "/shade_seconds");
        both(" s in shading; ", "/mean_cpu");
        text.emplace_back(" CPU s in all.");
    }
    if (!text.empty())
        text.emplace_back(" Fewer calls are what mixed gains; what it pays is to shade rays as "
                          "they come back, in smaller groups. On the thesis' GPU, where a call was "
                          "a round trip to another processor, the first weighed more than here.");
    return text;
}

Text kdtree_text(const Json& figures, const std::string& at) {
    const auto kdt = pointer_to(figures, at, "kdt"), batched = pointer_to(figures, at, "batched");
    if (!kdt || !batched)
        return {};
    return {"The CPU KD-tree takes ",
            number(figures, *kdt + "/mean_cpu"),
            " CPU s a frame, the thesis' two-level ",
            number(figures, *batched + "/mean_cpu"),
            ": the same cores do both, where the thesis had a GPU beside one core. Building them "
            "takes ",
            number(figures, *kdt + "/build_seconds"),
            " and ",
            number(figures, *batched + "/build_seconds"),
            " s."};
}

Table systems_table(const Json& figures, const std::string& at, const std::string& caption) {
    Table table;
    table.caption = caption;
    table.header = {"system",       "s a frame",        "CPU s a frame",     "GPU calls a frame",
                    "rays a frame", "passes s a frame", "shading s a frame", "MB moved a frame",
                    "build s"};
    const Json& systems = figures.at(Json::json_pointer(at));
    for (size_t i = 0; i < systems.size(); ++i) {
        if (systems[i]["key"] == "active")
            continue;
        table.rows.push_back({{systems[i]["name"].get<std::string>()}});
        for (const char* key : {"mean_seconds", "mean_cpu", "mean_calls", "mean_rays",
                                "pass_seconds", "shade_seconds", "moved_mb", "build_seconds"})
            table.rows.back().push_back({number(figures, fmt::format("{}/{}/{}", at, i, key))});
    }
    return table;
}

} // namespace ovc
