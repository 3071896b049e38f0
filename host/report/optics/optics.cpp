// SPDX-License-Identifier: Apache-2.0
// The rows of the optics table, and its text.
#include "host/report/optics/optics.h"

#include "host/report/optics/optics_exact.h"
#include "host/report/optics/optics_pictures.h"
#include "host/report/optics/optics_spawned.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace {

constexpr const char* kLegend = R"(
# Stiff optics

Light followed by the host's shading (host/shade/shade.h, host/shade/refract.h) over the plugin, certified.

- *leaks*: rays inside a closed shape that do not meet it again.
- *error*: the largest; relative to the length of a direction or of the way, or of a color.

)";

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
    size_t width = 4, counted = 0;
    for (const OpticsResult& r : results) {
        width = std::max(width, r.name.size());
        counted = std::max(counted, r.counted.size());
    }
    std::string text = kLegend;
    text += fmt::format("| {:<{}} | {:>10} | {:>5} | {:>5} | {:>8} | {:<{}} |\n", "case", width,
                        "rays", "wrong", "leaks", "error", "wrong means", counted);
    text += fmt::format("|{:-<{}}|{:->12}|{:->7}|{:->7}|{:->10}|{:-<{}}|\n", "", width + 2, ":",
                        ":", ":", ":", "", counted + 2);
    for (const OpticsResult& r : results)
        text += fmt::format("| {:<{}} | {:>10} | {:>5} | {:>5} | {:>8.1e} | {:<{}} |\n", r.name,
                            width, r.score.rays, r.score.wrong, r.score.leaks, r.score.error,
                            r.counted, counted);
    return text;
}

} // namespace ovc
