// SPDX-License-Identifier: Apache-2.0
// Writes the stability suite as text and as JSON.
#include "host/suites/stability/stability_table.h"

#include "host/arguments/memory_size.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ovc {

namespace {

/// Programs beside the certified one, whose rows follow it where they took part.
constexpr std::pair<const char*, std::optional<StabilityScore> StabilityResult::*> kPeers[] = {
    {"fast", &StabilityResult::fast},
    {"Embree robust", &StabilityResult::embree_robust},
    {"Embree default", &StabilityResult::embree_default}};

TextRow row_of(const StabilityResult& r, const char* program, const StabilityScore& score) {
    return {r.name,
            program,
            fmt::format("{}", r.triangles),
            fmt::format("{}", r.rays),
            fmt::format("{}", score.tied),
            fmt::format("{}", score.wrong),
            fmt::format("{}", score.leaks),
            score.t_error == 0 ? "0" : fmt::format("{:.1e}", score.t_error)};
}

void add_rows(const StabilityResult& r, std::vector<TextRow>& rows) {
    StabilityScore certified = r.certified;
    certified.wrong += r.wrong_occlusions;
    rows.push_back(row_of(r, "certified", certified));
    const double rays = std::max<double>(1, double(r.rays));
    rows.back().insert(rows.back().end(), {fmt::format("{:.2f}", 100 * double(r.flagged) / rays),
                                           fmt::format("{:.2f}", 100 * double(r.retraced) / rays),
                                           fmt::format("{:.2f}", r.microseconds)});
    for (const auto& [program, score] : kPeers)
        if (r.*score) {
            rows.push_back(row_of(r, program, *(r.*score)));
            rows.back().insert(rows.back().end(), {"", "", ""});
        }
}

std::string sums_of(std::span<const StabilityResult> results) {
    uint64_t rays = 0, wrong = 0, leaked = 0, reference_leaks = 0, miscounted = 0;
    std::string ratios;
    for (const StabilityResult& r : results) {
        rays += r.rays;
        wrong += r.certified.wrong + r.wrong_occlusions;
        leaked += r.certified.leaks;
        reference_leaks += r.reference_leaks;
        miscounted += r.miscounted;
        if (r.time_ratio > 0)
            ratios += fmt::format(
                "{}: {:.2f} times the time of '{}'{}, {} invalid rays and {} dropped "
                "triangles counted.\n",
                r.name, r.time_ratio, r.time_as,
                r.bar > 0 ? fmt::format(" (bar: {:.0f})", r.bar) : "", r.invalid, r.dropped);
    }
    return fmt::format("\n{} cases, {} rays. Certified: {} wrong, {} leaks; the reference: {} "
                       "leaks; {} miscounted.\n{}",
                       results.size(), human_count(rays), wrong, leaked, reference_leaks,
                       miscounted, ratios);
}

nlohmann::ordered_json json_of(const StabilityScore& score) {
    return {{"tied", score.tied},
            {"wrong", score.wrong},
            {"leaks", score.leaks},
            {"t_error", score.t_error}};
}

nlohmann::ordered_json json_of(const StabilityResult& r) {
    nlohmann::ordered_json object = {{"name", r.name},
                                     {"closed", r.closed},
                                     {"triangles", r.triangles},
                                     {"dropped", r.dropped},
                                     {"rays", r.rays},
                                     {"invalid", r.invalid},
                                     {"hits", r.hits},
                                     {"reference_leaks", r.reference_leaks},
                                     {"wrong_occlusions", r.wrong_occlusions},
                                     {"miscounted", r.miscounted},
                                     {"flagged", r.flagged},
                                     {"retraced", r.retraced},
                                     {"microseconds", r.microseconds},
                                     {"certified", json_of(r.certified)}};
    if (r.time_ratio > 0)
        object["time_ratio"] = r.time_ratio;
    if (r.bar > 0)
        object["bar"] = r.bar;
    if (r.fast)
        object["fast"] = json_of(*r.fast);
    if (r.embree_robust)
        object["embree_robust"] = json_of(*r.embree_robust);
    if (r.embree_default)
        object["embree_default"] = json_of(*r.embree_default);
    return object;
}

nlohmann::ordered_json json_of(const OpticsResult& r) {
    return {{"name", r.name},         {"rays", r.score.rays},   {"wrong", r.score.wrong},
            {"leaks", r.score.leaks}, {"error", r.score.error}, {"wrong_means", r.counted}};
}

template <class Result>
nlohmann::ordered_json list_of(std::span<const Result> results) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Result& result : results)
        list.push_back(json_of(result));
    return list;
}

} // namespace

std::string stability_markdown(const std::string& title, std::span<const StabilityResult> results) {
    std::vector<TextRow> rows = {{"case", "program", "triangles", "rays", "tied", "wrong", "leaks",
                                  "t error", "flagged %", "retraced %", "us/ray"}};
    for (const StabilityResult& result : results)
        add_rows(result, rows);
    return fmt::format("# {}\n\nRenderer: {}\n\n{}{}", title,
                       results.empty() ? "" : results[0].renderer, markdown_table(rows),
                       sums_of(results));
}

std::string stability_json(std::span<const StabilityResult> results,
                           std::span<const OpticsResult> optics) {
    nlohmann::ordered_json document = {{"renderer", results.empty() ? "" : results[0].renderer},
                                       {"cases", list_of(results)}};
    if (!optics.empty())
        document["optics"] = list_of(optics);
    return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace ovc
