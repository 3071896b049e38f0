// SPDX-License-Identifier: Apache-2.0
// overcast report: measurements that prove what the documents claim.
#include "host/arguments/arguments.h"
#include "host/arguments/backend_arguments.h"
#include "host/arguments/memory_size.h"
#include "host/backend/device_opening.h"
#include "host/command/command.h"
#include "host/output/output.h"
#include "host/report/make_report.h"
#include "host/scene/scene_source.h"
#include "host/suites/optics/optics.h"
#include "host/suites/stability/leak_cases.h"
#include "host/suites/stability/stability_grid.h"
#include "host/suites/stability/stability_meshes.h"
#include "host/suites/stability/stability_table.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>

namespace ovc {

static constexpr const char* kReportExamples =
    R"(Each experiment writes DIR/NAME.json; then tools/report, a Python program, makes DIR/index.html of
what is there, with the figures in DIR/page.json. Runs that are done are not repeated. Ctrl-C ends the
run that goes on; the same command goes on from there. The page needs python3-matplotlib and
python3-jinja2; without them the JSON is written all the same.

stability: rays at the edges and vertices of closed meshes, near and far; slivers, duplicates, deep
trees; a ground of 1e7 m with detail of 1 mm; grazing rays, rays along axes and in planes; NaN and
infinity. Wrong answers and leaks of certified and fast mode, and of Embree's default and robust mode
where this program was built with Embree. Then stiff optics: rays spawned on a thousand shapes from
1e-8 to 1e8 in size, refraction at indices near 1 and far from it and at the critical angle, mirrors
to depth 200.

leaks: certified mode alone, in large numbers: rays at edges and vertices of closed meshes, from
inside and outside, at the origin and far from it, small and large. With --data also at edges and
vertices of the dragon that its triangles surround without a gap; elsewhere it has holes.

grid: strips of triangles at every pair of scale and offset, for several aspects; as stability.

The tables go to standard output. Ctrl-C ends them early, with what there is so far. A report ends
with an error when certified mode, or the shading over it, answered anything wrong.

Examples:
  overcast report -o out --quick                       the page, in minutes
  overcast report -o out --data DATA                   with real scenes too, up to two hours
  overcast report -o out --quick --compare before      beside another report: what changed
  overcast report --only stability --quick             a minute
  overcast report --only stability -o out              out/stability.md and out/stability.json too
  overcast report --only leaks --rays 1e8 -o out       the long run; the files grow case by case)";

namespace {

struct ReportArguments {
    std::string only;
    std::string folder;
    std::string data;
    std::string compare;
    std::string kit;
    std::string backend; // empty: two-level
    std::string device;
    std::string kernel;
    std::string times;
    std::string rays;
    std::string name_part;
    std::vector<std::string> scenes;
    std::string size;
    bool quick = false;
};

/// The tables that --only can name; every other name is an experiment of the page.
constexpr std::string_view kReports[] = {"stability", "leaks", "grid"};

/// In the order of ovc_kernel.
constexpr std::string_view kKernels[] = {"auto", "fragment", "compute"};

bool is_page(const std::string& name) {
    return std::find(std::begin(kReports), std::end(kReports), name) == std::end(kReports);
}

/// Parses a whole number such as "100000000" or "1e8".
Result<uint64_t> parse_rays(const std::string& text) {
    constexpr double kMaxRays = 1e12;
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value);
    if (failure != std::errc{} || stop != end || !(value >= 1 && value <= kMaxRays) ||
        value != std::floor(value))
        return Error{fmt::format("--rays needs a whole number from 1 to {:.0e}, such as 1e8, not "
                                 "'{}'",
                                 kMaxRays, text)};
    return uint64_t(value);
}

Result<StabilityOptions> options_of(const ReportArguments& given) {
    StabilityOptions options;
    options.times = given.quick ? 1 : 10;
    const Result<BackendKind> kind =
        parse_backend(given.backend.empty() ? "two-level" : given.backend);
    if (!kind)
        return kind.error();
    options.backend.kind = *kind;
    options.backend.device = given.device;
    OptionReader reader;
    reader.count("--times", given.times, 1, 1'000'000, options.times);
    reader.choice("--kernel", given.kernel, kKernels, options.backend.kernel);
    return reader.done() ? Result<StabilityOptions>(options) : reader.done().error();
}

/// The cases and options of one of the tables.
struct Report {
    std::string name;
    std::string title;
    std::vector<StabilityCase> cases;
    std::vector<OpticsCase> optics; // run after the cases
    StabilityOptions options;
    std::unique_ptr<const Scene> dragon = nullptr; // which cases borrow
};

/// Returns the scan in the folder of --data, or null where that is not given.
Result<std::unique_ptr<const Scene>> dragon_of(const std::string& data) {
    return data.empty() ? std::unique_ptr<const Scene>() : load_dragon(data);
}

/// Keeps the cases whose name contains `part`.
Result<Done> choose(Report& report, const std::string& part) {
    const auto is_other = [&](const auto& one) { return one.name.find(part) == std::string::npos; };
    std::erase_if(report.cases, is_other);
    std::erase_if(report.optics, is_other);
    if (report.cases.empty() && report.optics.empty())
        return Error{fmt::format("--case: no case of the report has '{}' in its name", part)};
    return Done{};
}

Result<Report> chosen_of(Report report, const std::string& part) {
    const Result<Done> chosen = choose(report, part);
    return chosen ? Result<Report>(std::move(report)) : chosen.error();
}

Result<Report> stability_report(const ReportArguments& given) {
    if (!given.rays.empty())
        return Error{
            fmt::format("--rays means nothing to the report {}; there is --times", given.only)};
    Result<StabilityOptions> options = options_of(given);
    if (!options)
        return options.error();
    if (given.only == kReports[2])
        return chosen_of({"grid",
                          "Scale, offset and aspect",
                          stability_grid_cases(given.quick),
                          {},
                          std::move(*options)},
                         given.name_part);
    Result<std::unique_ptr<const Scene>> dragon = dragon_of(given.data);
    if (!dragon)
        return dragon.error();
    return chosen_of({"stability", "Numerical stability", stability_cases(dragon->get()),
                      optics_cases(), std::move(*options), std::move(*dragon)},
                     given.name_part);
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
    Result<std::unique_ptr<const Scene>> dragon = dragon_of(given.data);
    if (!dragon)
        return dragon.error();
    Report report{"leaks", "Leaks at edges and vertices", leak_cases(dragon->get()),
                  {},      std::move(*options),           std::move(*dragon)};
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

    /// Returns a table for each kind of case that was run.
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

/// Prints a line for each case, on a terminal alone. It overwrites the line while the case runs.
void print_progress(const StabilityResult& r, bool finished) {
    if (isatty(STDERR_FILENO))
        write_to_standard_error(fmt::format(
            "\r{}: {} rays, {} wrong, {} leaks\033[K{}", r.name, human_count(r.rays),
            r.certified.wrong + r.wrong_occlusions, r.certified.leaks, finished ? "\n" : ""));
}

void print_progress(const OpticsResult& r) {
    if (isatty(STDERR_FILENO))
        write_to_standard_error(fmt::format("{}: {} rays, {} wrong, {} leaks\n", r.name,
                                            human_count(r.score.rays), r.score.wrong,
                                            r.score.leaks));
}

/// Runs all cases in turn, and calls `seen` after each with the results so far.
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

/// Runs the cases and prints their tables. Where a folder is given it saves the results after each
/// case.
Result<int> make_report(const Report& report, const std::string& folder) {
    if (!folder.empty())
        if (const Result<Done> made = make_folder(folder, report); !made)
            return made.error();
    prepare_process(report.options.backend); // so that kernels are those that render has
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

/// Refuses a page without a folder, and options that only the tables take.
Result<Done> check_page_words(const ReportArguments& given) {
    if (given.folder.empty())
        return Error{"the report needs a folder: overcast report -o DIR"};
    for (const auto& [name, text] :
         {std::pair("--times", &given.times), std::pair("--rays", &given.rays),
          std::pair("--case", &given.name_part), std::pair("--backend", &given.backend),
          std::pair("--device", &given.device), std::pair("--kernel", &given.kernel)})
        if (!text->empty())
            return Error{fmt::format("{} goes with --only stability, leaks or grid", name)};
    for (const auto& [name, folder] :
         {std::pair("--data", &given.data), std::pair("--compare", &given.compare)})
        if (!folder->empty() && !std::filesystem::is_directory(*folder))
            return Error{fmt::format("{}: there is no folder '{}'", name, *folder)};
    if (!given.kit.empty() && !std::filesystem::exists(given.kit))
        return Error{fmt::format("--kit: there is no file '{}'", given.kit)};
    return Done{};
}

Result<ReportJob> page_job(const ReportArguments& given) {
    if (!given.only.empty())
        if (const Result<const Experiment*> one = find_experiment(given.only); !one)
            return one.error();
    if (const Result<Done> fine = check_page_words(given); !fine)
        return fine.error();
    ReportJob job;
    job.only = given.only;
    job.folder = given.folder;
    job.plan.quick = given.quick;
    job.plan.scenes = given.scenes;
    job.plan.data = given.data;
    job.compare = given.compare;
    job.kit = given.kit;
    if (!given.size.empty())
        if (const Result<ImageSize> size = parse_size("--size", given.size); !size)
            return size.error();
    job.plan.size = given.size;
    if (!given.data.empty())
        if (const Result<std::string> dragon = dragon_file(given.data); dragon)
            job.plan.mesh = *dragon;
    return job;
}

std::string experiments_text() {
    std::string text;
    for (const Experiment& one : experiments())
        text += fmt::format("  {}: {}\n", one.name, one.about);
    return text;
}

class ReportCommand final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Measures what the documents claim.");
        app.add_option("--only", given_.only,
                       "One experiment of the page; or one of the tables stability, leaks and grid")
            ->type_name("NAME");
        app.add_option("-o,--output", given_.folder,
                       "The folder of the page; tables: also write NAME.md and NAME.json there")
            ->type_name("DIR");
        app.add_flag("--quick", given_.quick, "The short form, in minutes; for leaks, 1e6 rays");
        app.add_option("--scene", given_.scenes,
                       "Instead of the scenes of the page's experiments; may come several times")
            ->type_name("SCENE");
        app.add_option("--size", given_.size,
                       "Instead of the size of the page's pictures and measurements; squares "
                       "have its height")
            ->type_name("WxH");
        app.add_option("--times", given_.times,
                       "For stability: so many times the rays of the short form; default: 10")
            ->type_name("N");
        app.add_option("--rays", given_.rays, "For leaks: how many rays altogether; default: 1e8")
            ->type_name("N");
        app.add_option("--case", given_.name_part, "Only the cases with this in their name")
            ->type_name("TEXT");
        app.add_option("--data", given_.data,
                       "A folder of real scenes, such as meshes/stanford-dragon/dragon_vrip.ply")
            ->type_name("DIR");
        app.add_option("--compare", given_.compare,
                       "The folder of another report, which the page puts beside this one")
            ->type_name("DIR");
        app.add_option("--kit", given_.kit,
                       "The kit.json of a machine with a GPU, which the page shows as well")
            ->type_name("FILE");
        app.add_option(
               "--backend", given_.backend,
               "What is asked: two-level (the default) or another that `overcast trace` has")
            ->type_name("NAME");
        app.add_option("--device", given_.device,
                       "A number or a part of a name from `overcast devices`")
            ->type_name("NAME");
        app.add_option("--kernel", given_.kernel, "auto (the faster one), fragment or compute")
            ->type_name(choice_names(kKernels));
        app.footer("The experiments of the page:\n" + experiments_text() + "\n" + kReportExamples);
    }

    Result<int> run() override {
        if (is_page(given_.only)) {
            const Result<ReportJob> job = page_job(given_);
            return job ? make_report_page(*job) : job.error();
        }
        for (const auto& [name, is_given] : {std::pair("--scene", !given_.scenes.empty()),
                                             std::pair("--size", !given_.size.empty()),
                                             std::pair("--compare", !given_.compare.empty()),
                                             std::pair("--kit", !given_.kit.empty())})
            if (is_given)
                return Error{fmt::format(
                    "{} goes with the page, not with --only stability, leaks or grid", name)};
        Result<Report> report =
            given_.only == kReports[1] ? leak_report(given_) : stability_report(given_);
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
