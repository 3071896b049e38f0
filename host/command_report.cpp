// SPDX-License-Identifier: Apache-2.0
// overcast report: measurements that prove what the documents claim.
#include "host/arguments.h"
#include "host/backend_arguments.h"
#include "host/command.h"
#include "host/interrupt.h"
#include "host/memory_size.h"
#include "host/output.h"
#include "host/report/leak_cases.h"
#include "host/report/optics.h"
#include "host/report/stability_table.h"
#include "host/scene_source.h"
#include "host/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>

namespace ovc {

static constexpr const char* kExamples =
    R"(stability: rays at the edges and vertices of closed meshes, near and far; slivers, duplicates, deep
trees; a ground of 1e7 m with detail of 1 mm; grazing rays, rays along axes and in planes; NaN and
infinity. Wrong answers and leaks of certified and fast mode, and of Embree's default and robust mode
where this program was built with Embree. Then stiff optics: rays spawned on a thousand shapes from
1e-8 to 1e8 in size, refraction at indices near 1 and far from it and at the critical angle, mirrors
to depth 200.

leaks: certified mode alone, in large numbers: rays at edges and vertices of closed meshes, from
inside and outside, at the origin and far from it, small and large. With --data also at edges and
vertices of the dragon that its triangles surround without a gap; elsewhere it has holes.

The tables go to standard output. Ctrl-C ends them early, with what there is so far. A report ends
with an error when certified mode, or the shading over it, answered anything wrong.

Examples:
  overcast report --only stability --quick             a minute
  overcast report --only stability -o out              out/stability.md and out/stability.json too
  overcast report --only leaks --rays 1e8 -o out       the long run; the files grow case by case)";

namespace {

struct ReportArguments {
    std::string only;
    std::string folder;
    std::string data;
    std::string backend = "two-level";
    std::string device;
    std::string kernel = "auto";
    std::string times;
    std::string rays;
    std::string name_part;
    bool quick = false;
};

/// All of the design; the first two are there.
constexpr std::string_view kReports[] = {"stability", "leaks", "speed", "memory", "scenes"};

/// In the order of ovc_kernel.
constexpr std::string_view kKernels[] = {"auto", "fragment", "compute"};

Result<Done> check_name(const std::string& name) {
    if (name == kReports[0] || name == kReports[1])
        return Done{};
    if (name.empty())
        return Error{"the whole report is not there yet; there are --only stability and leaks"};
    if (std::find(std::begin(kReports), std::end(kReports), name) != std::end(kReports))
        return Error{
            fmt::format("the report '{}' is not there yet; there are stability and leaks", name)};
    return Error{fmt::format("no report is called '{}'; there are stability and leaks{}", name,
                             did_you_mean(name, kReports))};
}

/// "100000000" or "1e8".
Result<uint64_t> parse_rays(const std::string& text) {
    constexpr double most = 1e12;
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || stop != end || !(value >= 1 && value <= most) ||
        value != std::floor(value))
        return Error{fmt::format("--rays needs a whole number from 1 to {:.0e}, such as 1e8, not "
                                 "'{}'",
                                 most, text)};
    return uint64_t(value);
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
    const Result<BackendKind> kind = parse_backend(given.backend);
    if (!kind)
        return kind.error();
    options.backend.kind = *kind;
    options.backend.device = given.device;
    const Result<size_t> kernel = parse_choice("--kernel", given.kernel, kKernels);
    if (!kernel)
        return kernel.error();
    options.backend.kernel = ovc_kernel(*kernel);
    return options;
}

/// What one of the reports runs.
struct Report {
    std::string name;
    std::string title;
    std::vector<StabilityCase> cases;
    std::vector<OpticsCase> optics; // after the cases
    StabilityOptions options;
};

/// Keeps the cases whose name contains `part`.
Result<Done> choose(Report& report, const std::string& part) {
    const auto is_other = [&](const auto& one) { return one.name.find(part) == std::string::npos; };
    std::erase_if(report.cases, is_other);
    std::erase_if(report.optics, is_other);
    if (report.cases.empty() && report.optics.empty())
        return Error{fmt::format("--case: no case of the report has '{}' in its name", part)};
    return Done{};
}

Result<Report> stability_report(const ReportArguments& given) {
    if (!given.rays.empty())
        return Error{"--rays means nothing to the report stability; there is --times"};
    Result<StabilityOptions> options = options_of(given);
    if (!options)
        return options.error();
    Result<std::vector<StabilityCase>> cases = stability_cases(given.data);
    if (!cases)
        return cases.error();
    Report report{"stability", "Numerical stability", std::move(*cases), optics_cases(),
                  std::move(*options)};
    if (const Result<Done> chosen = choose(report, given.name_part); !chosen)
        return chosen.error();
    return report;
}

Result<Report> leak_report(const ReportArguments& given) {
    if (!given.times.empty())
        return Error{"--times means nothing to the report leaks; there is --rays"};
    Result<StabilityOptions> options = options_of(given);
    if (!options)
        return options.error();
    options->times = 1;
    options->peers = false;
    const std::string rays = !given.rays.empty() ? given.rays : given.quick ? "1e6" : "1e8";
    const Result<uint64_t> count = parse_rays(rays);
    if (!count)
        return count.error();
    Result<std::vector<StabilityCase>> cases = leak_cases(given.data);
    if (!cases)
        return cases.error();
    Report report{
        "leaks", "Leaks at edges and vertices", std::move(*cases), {}, std::move(*options)};
    if (const Result<Done> chosen = choose(report, given.name_part); !chosen)
        return chosen.error();
    share_rays(report.cases, *count);
    return report;
}

Result<Done> make_folder(const std::string& folder, const Report& report) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return Error{fmt::format("cannot make the folder '{}': {}", folder, error.message())};
    return check_writable("report", std::filesystem::path(folder) / (report.name + ".md"));
}

struct Results {
    std::vector<StabilityResult> cases;
    std::vector<OpticsResult> optics;

    /// A table for each kind of case that was run.
    std::string markdown(const std::string& title) const {
        return (cases.empty() ? "" : stability_markdown(title, cases)) +
               (optics.empty() ? "" : optics_markdown(optics));
    }
};

Result<Done> save(const std::string& folder, const Report& report, const Results& results) {
    const std::filesystem::path path = folder;
    if (const Result<Done> saved =
            save_text(results.markdown(report.title), path / (report.name + ".md"));
        !saved)
        return saved;
    return save_text(stability_json(results.cases, results.optics), path / (report.name + ".json"));
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

/// One line a case on a terminal, which overwrites itself while the case runs.
void print_progress(const StabilityResult& r, bool finished) {
    if (isatty(STDERR_FILENO))
        fmt::print(stderr, "\r{}: {} rays, {} wrong, {} leaks\033[K{}", r.name, human_count(r.rays),
                   r.certified.wrong + r.wrong_occlusions, r.certified.leaks, finished ? "\n" : "");
}

void print_progress(const OpticsResult& r) {
    if (isatty(STDERR_FILENO))
        fmt::print(stderr, "{}: {} rays, {} wrong, {} leaks\n", r.name, human_count(r.score.rays),
                   r.score.wrong, r.score.leaks);
}

/// All cases in turn; after each, `seen` gets what is known so far.
Result<Results> run_all(const Report& report, const InterruptGuard& interrupt,
                        const std::function<void(const Results&)>& seen) {
    Results results;
    StabilityOptions options = report.options;
    options.go_on = [&](const StabilityResult& so_far) {
        print_progress(so_far, /* finished= */ false);
        return !interrupt.interrupted();
    };
    const auto answers =
        run_stability(report.cases, options, {}, [&](const StabilityResult& result) {
            print_progress(result, /* finished= */ true);
            results.cases.push_back(result);
            seen(results);
        });
    if (!answers)
        return answers.error();
    OpticsOptions optics_options;
    optics_options.backend = options.backend;
    optics_options.times = options.times;
    optics_options.go_on = [&] { return !interrupt.interrupted(); };
    const auto optics =
        run_optics(report.optics, optics_options, {}, [&](const OpticsResult& result) {
            print_progress(result);
            results.optics.push_back(result);
            seen(results);
        });
    if (!optics)
        return optics.error();
    return results;
}

/// Runs the cases; files, if any, have all that is known after each.
Result<int> make_report(const Report& report, const std::string& folder) {
    if (!folder.empty())
        if (const Result<Done> made = make_folder(folder, report); !made)
            return made.error();
    const InterruptGuard interrupt;
    Result<Done> saved = Done{};
    const Result<Results> results = run_all(report, interrupt, [&](const Results& so_far) {
        if (saved && !folder.empty())
            saved = save(folder, report, so_far);
    });
    if (!results)
        return results.error();
    if (!saved)
        return saved.error();
    fmt::print("{}", results->markdown(report.title));
    if (!all_right(*results))
        return Error{"something was answered wrong: see the columns wrong and leaks"};
    return interrupt.interrupted() ? kExitInterrupted : kExitOk;
}

class ReportCommand final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Measures what the documents claim.");
        app.add_option("--only", given_.only, "The report to make: stability or leaks")
            ->type_name("stability|leaks");
        app.add_option("-o,--output", given_.folder,
                       "Also write NAME.md and NAME.json into this folder")
            ->type_name("DIR");
        app.add_flag("--quick", given_.quick,
                     "The short form: a tenth of the rays; for leaks, 1e6");
        app.add_option("--times", given_.times,
                       "For stability: so many times the rays of the short form; default: 10")
            ->type_name("N");
        app.add_option("--rays", given_.rays, "For leaks: how many rays altogether; default: 1e8")
            ->type_name("N");
        app.add_option("--case", given_.name_part, "Only the cases with this in their name")
            ->type_name("TEXT");
        app.add_option(
               "--data", given_.data,
               "A folder with meshes/stanford-dragon/dragon_vrip.ply, for cases on the dragon")
            ->type_name("DIR");
        app.add_option(
               "--backend", given_.backend,
               "What is asked: two-level (the default) or another that `overcast trace` has")
            ->type_name("NAME");
        app.add_option("--device", given_.device,
                       "A number or a part of a name from `overcast devices`")
            ->type_name("NAME");
        app.add_option("--kernel", given_.kernel, "auto (the faster one), fragment or compute")
            ->type_name(choice_names(kKernels));
        app.footer(kExamples);
    }

    Result<int> run() override {
        if (const Result<Done> known = check_name(given_.only); !known)
            return known.error();
        Result<Report> report =
            given_.only == kReports[0] ? stability_report(given_) : leak_report(given_);
        if (!report)
            return report.error();
        return make_report(*report, given_.folder);
    }

private:
    ReportArguments given_;
};

} // namespace

std::unique_ptr<Subcommand> make_report() {
    return std::make_unique<ReportCommand>();
}

} // namespace ovc
