// SPDX-License-Identifier: Apache-2.0
// The rows of the optics table, and its text.
#include "host/suites/optics/optics.h"

#include "host/suites/optics/optics_exact.h"
#include "host/suites/optics/optics_pictures.h"
#include "host/suites/optics/optics_spawned.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>

#include <cmath>

namespace ovc {

namespace {

void add_spawned(std::vector<OpticsCase>& cases) {
    for (int exponent = -8; exponent <= 8; exponent += 2)
        cases.push_back({fmt::format("spawned rays, shapes of 1e{}", exponent),
                         "the wrong side, or a convex shape met again",
                         [=](const OpticsOptions& options, const LogSink& log) {
                             return spawned_rays(options, log, std::pow(10.0, exponent));
                         }});
}

void add_formulas(std::vector<OpticsCase>& cases) {
    constexpr std::pair<const char*, double> indices[] = {
        {"1 + 1e-12", 1 + 1e-12}, {"1 - 1e-12", 1 - 1e-12}, {"1.5", 1.5}, {"1e3", 1e3}};
    for (const auto& [name, ior] : indices)
        cases.push_back({fmt::format("Snell's law, index {}", name),
                         "not long double's to rounding",
                         [ior = ior](const OpticsOptions& options, const LogSink&) {
                             return Result<OpticsScore>(snell(options, ior));
                         }});
    for (const auto& [name, ior] : indices)
        cases.push_back({fmt::format("critical angle, index {}", name),
                         "reflected unlike in long double",
                         [ior = ior](const OpticsOptions& options, const LogSink&) {
                             return Result<OpticsScore>(critical_angle(options, ior));
                         }});
    cases.push_back(
        {"facing mirrors to depth 200", "rays of another number of bounces", facing_mirrors});
}

void add_pictures(std::vector<OpticsCase>& cases) {
    for (const auto& [name, ior] :
         {std::pair{"1 + 1e-12", 1 + 1e-12}, {"1 - 1e-12", 1 - 1e-12}, {"1", 1.0}})
        cases.push_back({fmt::format("a clear sphere of index {}", name), "pixels that show it",
                         [ior = ior](const OpticsOptions& options, const LogSink& log) {
                             return unseen_glass(options, log, ior);
                         }});
    cases.push_back({"glass and mirror at UTM", "pixels unlike those at the origin", far_glass});
}

} // namespace

std::vector<OpticsCase> optics_cases() {
    std::vector<OpticsCase> cases;
    add_spawned(cases);
    add_formulas(cases);
    add_pictures(cases);
    return cases;
}

Result<std::vector<OpticsResult>> run_optics(std::span<const OpticsCase> cases,
                                             const OpticsOptions& options, const LogSink& log,
                                             const std::function<void(const OpticsResult&)>& seen) {
    std::vector<OpticsResult> results;
    for (const OpticsCase& one : cases) {
        if (options.go_on && !options.go_on())
            break;
        const Result<OpticsScore> score = one.run(options, log);
        if (!score)
            return Error{one.name + ": " + score.error().message};
        results.push_back({one.name, one.wrong, *score});
        seen(results.back());
    }
    return results;
}

std::string optics_markdown(std::span<const OpticsResult> results) {
    std::vector<TextRow> rows = {{"case", "rays", "wrong", "leaks", "error", "wrong means"}};
    for (const OpticsResult& r : results)
        rows.push_back({r.name, fmt::format("{}", r.score.rays), fmt::format("{}", r.score.wrong),
                        fmt::format("{}", r.score.leaks), fmt::format("{:.1e}", r.score.error),
                        r.counted});
    return "\n# Stiff optics\n\n" + markdown_table(rows);
}

} // namespace ovc
