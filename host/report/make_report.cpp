// SPDX-License-Identifier: Apache-2.0
// Runs the experiments, and then the Python program that lies beside this one.
#include "host/report/make_report.h"

#include "host/bench/programs/run_program.h"
#include "host/output/output.h"
#include "host/report/experiments/experiment_file.h"
#include "host/report/experiments/run_experiments.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>

namespace ovc {

namespace fs = std::filesystem;

/// The path from bin/, which is the same in a build tree and in an installation.
static constexpr const char* kToolsFromCommand = "../share/overcast/report";

static Result<Done> make_folders(const std::string& folder) {
    std::error_code error;
    fs::create_directories(fs::path(folder) / "pictures", error);
    if (error)
        return Error{fmt::format("cannot make the folder '{}': {}", folder, error.message())};
    return check_writable("report", fs::path(folder) / "index.html");
}

/// Writes the page. Error: Python, or a package of it, is missing, or says what is wrong.
static Result<Done> write_page(const ReportJob& job, const fs::path& program) {
    const std::string installs = "apt install python3 python3-matplotlib python3-jinja2";
    if (!is_installed("python3"))
        return Error{fmt::format("the JSON is in '{}', but the page needs Python: {}", job.folder,
                                 installs)};
    const fs::path tools = (program.parent_path() / kToolsFromCommand).lexically_normal();
    Words words = {"python3", "-B", tools.string(), job.folder};
    if (!job.compare.empty())
        words = with_words(std::move(words), {"--compare", job.compare});
    if (!job.kit.empty())
        words = with_words(std::move(words), {"--kit", job.kit});
    const Result<ProgramEnd> end =
        watch_program(words, std::numeric_limits<double>::infinity(), {});
    if (!end)
        return end.error();
    return end->exit_code == 0 ? Result<Done>(Done{})
                               : Error{fmt::format("the JSON is in '{}', but not the page: {}",
                                                   job.folder, end->said)};
}

Result<int> make_report_page(const ReportJob& job) {
    if (const Result<Done> made = make_folders(job.folder); !made)
        return made.error();
    const InterruptGuard interrupt("ending this run; those that are done are kept");
    TerminalLine progress;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const RunSurroundings around{program, build_text(program), job.folder,
                                 [&] { return interrupt.interrupted(); },
                                 [&](const std::string& what) { progress.show(what); }};
    const Result<std::vector<std::string>> troubles =
        run_experiments(experiments(), job.only, job.plan, around);
    progress.clear();
    if (!troubles)
        return troubles.error();
    if (const Result<Done> written = write_page(job, program); !written)
        return written.error();
    fmt::print("{}\n", (fs::path(job.folder) / "index.html").string());
    if (interrupt.interrupted())
        return kExitInterrupted;
    if (!troubles->empty())
        return Error{fmt::format("{} things went wrong or were answered wrong; the page names "
                                 "them, the first: {}",
                                 troubles->size(), troubles->front())};
    return kExitOk;
}

} // namespace ovc
