// SPDX-License-Identifier: Apache-2.0
// overcast report: measurements that prove what the documents claim.
#include "host/arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/output.h"
#include "host/report/stability_table.h"
#include "host/scene_source.h"
#include "host/suggestion.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

namespace ovc {

static constexpr const char* kExamples =
    R"(stability: rays at the edges and vertices of closed meshes, near and far; slivers, duplicates, deep
trees; grazing rays, rays along axes and in planes; NaN and infinity. Wrong answers and leaks of
certified and fast mode, and of Embree's robust mode where this program was built with Embree. Then
stiff optics: rays spawned on a thousand shapes from 1e-8 to 1e8 in size, refraction at indices near
1 and far from it and at the critical angle, mirrors to depth 200. The tables go to standard output.
It ends with an error when certified mode answered anything wrong.

Examples:
  overcast report --only stability --quick             a minute
  overcast report --only stability -o out              out/stability.md and out/stability.json too
  overcast report --only stability --times 2000        the long run)";

namespace {

struct ReportArguments {
    std::string only;
    std::string folder;
    std::string data;
    std::string device;
    std::string kernel;
    std::string times;
    bool quick = false;
};

/// All of the design; the first is there.
constexpr std::string_view kReports[] = {"stability", "speed", "memory", "scenes"};

Result<Done> check_name(const std::string& name) {
    if (name == kReports[0])
        return Done{};
    if (name.empty())
        return Error{"the whole report is not there yet; there is --only stability"};
    if (std::find(std::begin(kReports), std::end(kReports), name) != std::end(kReports))
        return Error{fmt::format("the report '{}' is not there yet; there is stability", name)};
    return Error{fmt::format("no report is called '{}'; there is stability{}", name,
                             did_you_mean(name, kReports))};
}

Result<StabilityOptions> options_of(const ReportArguments& given) {
    StabilityOptions options;
    options.times = given.quick ? 1 : 10;
    if (!given.times.empty()) {
        const Result<uint64_t> times = parse_count("--times", given.times, 1, 1'000'000);
        if (!times)
            return times.error();
        options.times = *times;
    }
    options.backend.device = given.device;
    constexpr std::string_view kernels[] = {"", "fragment", "compute"};
    const auto kernel = std::find(std::begin(kernels), std::end(kernels), given.kernel);
    if (kernel == std::end(kernels))
        return Error{fmt::format("--kernel: '{}' is neither fragment nor compute", given.kernel)};
    options.backend.kernel = ovc_kernel(kernel - std::begin(kernels));
    return options;
}

Result<Done> make_folder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return Error{fmt::format("cannot make the folder '{}': {}", folder, error.message())};
    return check_writable("report", std::filesystem::path(folder) / "stability.md");
}

struct Results {
    std::vector<StabilityResult> cases;
    std::vector<OpticsResult> optics;

    std::string markdown() const { return stability_markdown(cases) + optics_markdown(optics); }
};

Result<Done> save(const std::string& folder, const Results& results) {
    const std::filesystem::path path = folder;
    if (const Result<Done> saved = save_text(results.markdown(), path / "stability.md"); !saved)
        return saved;
    return save_text(stability_json(results.cases, results.optics), path / "stability.json");
}

bool all_right(const Results& results) {
    return std::ranges::all_of(results.cases,
                               [](const StabilityResult& r) {
                                   return r.certified.wrong + r.wrong_occlusions +
                                              r.certified.leaks + r.miscounted ==
                                          0;
                               }) &&
           std::ranges::all_of(results.optics, [](const OpticsResult& r) {
               return r.score.wrong + r.score.leaks == 0;
           });
}

void print_line(const std::string& name, uint64_t rays, uint64_t wrong, uint64_t leaks) {
    if (isatty(STDERR_FILENO))
        fmt::print(stderr, "{}: {} rays, {} wrong, {} leaks\n", name, rays, wrong, leaks);
}

Result<Results> run_all(std::span<const StabilityCase> cases, const StabilityOptions& options) {
    Result<std::vector<StabilityResult>> answers =
        run_stability(cases, options, {}, [](const StabilityResult& r) {
            print_line(r.name, r.rays, r.certified.wrong + r.wrong_occlusions, r.certified.leaks);
        });
    if (!answers)
        return answers.error();
    OpticsOptions optics_options;
    optics_options.backend = options.backend;
    optics_options.times = options.times;
    Result<std::vector<OpticsResult>> optics =
        run_optics(optics_cases(), optics_options, {}, [](const OpticsResult& r) {
            print_line(r.name, r.score.rays, r.score.wrong, r.score.leaks);
        });
    if (!optics)
        return optics.error();
    return Results{std::move(*answers), std::move(*optics)};
}

Result<int> report_stability(const ReportArguments& given) {
    const Result<StabilityOptions> options = options_of(given);
    if (!options)
        return options.error();
    if (!given.folder.empty())
        if (const Result<Done> made = make_folder(given.folder); !made)
            return made.error();
    const Result<std::vector<StabilityCase>> cases = stability_cases(given.data);
    if (!cases)
        return cases.error();
    const Result<Results> results = run_all(*cases, *options);
    if (!results)
        return results.error();
    fmt::print("{}", results->markdown());
    if (!given.folder.empty())
        if (const Result<Done> saved = save(given.folder, *results); !saved)
            return saved.error();
    if (!all_right(*results))
        return Error{"something was answered wrong: see the columns wrong and leaks"};
    return kExitOk;
}

} // namespace

Result<int> run_report(const Arguments& arguments) {
    CLI::App app{"Measures what the documents claim.", "overcast report"};
    ReportArguments given;
    app.add_option("--only", given.only, "The report to make: stability")->type_name("NAME");
    app.add_option("-o,--output", given.folder, "Also write NAME.md and NAME.json into this folder")
        ->type_name("DIR");
    app.add_flag("--quick", given.quick, "The short form: a tenth of the rays");
    app.add_option("--times", given.times,
                   "Instead: so many times the rays of the short form; default: 10")
        ->type_name("N");
    app.add_option("--data", given.data,
                   "A folder with meshes/stanford-dragon/dragon_vrip.ply, for cases on the dragon")
        ->type_name("DIR");
    app.add_option("--device", given.device, "A number or a part of a name from `overcast devices`")
        ->type_name("NAME");
    app.add_option("--kernel", given.kernel, "fragment or compute; default: the faster one")
        ->type_name("NAME");
    app.footer(kExamples);
    const Result<Parsed> parsed = parse_arguments(app, arguments);
    if (!parsed)
        return parsed.error();
    if (*parsed == Parsed::HelpShown)
        return kExitOk;
    if (const Result<Done> known = check_name(given.only); !known)
        return known.error();
    return report_stability(given);
}

} // namespace ovc
