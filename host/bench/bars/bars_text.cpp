// SPDX-License-Identifier: Apache-2.0
// Writes bars as a table for people and as JSON for programs (docs/benchmarks.md).
#include "host/bench/bars/bars.h"
#include "host/bench/bench_text.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ovc {

/// Writes ratios to a hundredth, and bytes and MB/s as whole numbers.
static std::string number(double value) {
    return fmt::format("{:.{}f}", value, value >= 20 ? 0 : 2);
}

std::string bars_table(std::span<const Bar> bars) {
    std::vector<TextRow> rows = {{"line", "measured", "from", "to", "at least", "aim", "", "of"}};
    for (const Bar& bar : bars) {
        const bool promised = bar.at_least > 0 || bar.measured;
        const char* sign = bar.better == Better::Less ? "at most " : "";
        rows.push_back({bar.what, bar.measured ? number(*bar.measured) : "-",
                        bar.turns ? number(bar.turns->low) : "-",
                        bar.turns ? number(bar.turns->high) : "-",
                        promised ? sign + number(bar.at_least) : "-",
                        promised ? number(bar.aim) : "-", std::string(verdict(bar)), bar.note});
    }
    const auto count = [&](std::string_view v) {
        return std::count_if(bars.begin(), bars.end(),
                             [&](const Bar& bar) { return verdict(bar) == v; });
    };
    std::string text =
        fmt::format("{}\n{} lines hold, {} do not, {} were not measured here.\n",
                    markdown_table(rows), count("passed"), count("failed"), count("skipped"));
    if (const auto noisy = count("too noisy"); noisy > 0)
        text += fmt::format("{} are too noisy to judge: their turns lie on both sides of the bar. "
                            "More --repeats, or a quieter machine, tell.\n",
                            noisy);
    return text;
}

std::string failed_bars(std::span<const Bar> bars) {
    std::vector<std::string_view> failed;
    for (const Bar& bar : bars)
        if (verdict(bar) == "failed")
            failed.push_back(bar.what);
    return failed.empty() ? ""
                          : fmt::format("{} of {} lines do not hold: {}", failed.size(),
                                        bars.size(), fmt::join(failed, "; "));
}

std::string bars_json(std::span<const Bar> bars, std::span<const BenchResult> results,
                      const ProgramsResult* programs) {
    using Json = nlohmann::ordered_json;
    Json lines = Json::array();
    for (const Bar& bar : bars)
        lines.push_back({{"line", bar.what},
                         {"measured", bar.measured ? Json(*bar.measured) : Json(nullptr)},
                         {"low", bar.turns ? Json(bar.turns->low) : Json(nullptr)},
                         {"high", bar.turns ? Json(bar.turns->high) : Json(nullptr)},
                         {"at_least", bar.at_least},
                         {"aim", bar.aim},
                         {"better", bar.better == Better::More ? "more" : "less"},
                         {"verdict", verdict(bar)},
                         {"note", bar.note}});
    Json document = {{"bars", lines}};
    document["programs"] = programs ? Json::parse(programs_json(*programs)) : Json(nullptr);
    document["scenes"] = Json::parse(bench_json(results))["scenes"];
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace ovc
