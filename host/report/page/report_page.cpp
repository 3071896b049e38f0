// SPDX-License-Identifier: Apache-2.0
// Makes the report as a whole: folders, runs, sections, plots and pages.
#include "host/report/page/report_page.h"

#include "core/system/parallel.h"
#include "host/output/output.h"
#include "host/report/experiments/raw_results.h"
#include "host/report/experiments/run_experiments.h"
#include "host/report/page/draw_plot.h"
#include "host/report/page/page_html.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/terminal_line.h"
#include "host/terminal/version.h"

#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace ovc {

namespace {

namespace fs = std::filesystem;

std::string today() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    localtime_r(&now, &parts);
    std::string text(16, '\0');
    text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts));
    return text;
}

/// Returns "AMD EPYC 9R14, 2 threads", with the name that Linux gives; elsewhere the threads alone.
std::string machine_text() {
    std::ifstream info("/proc/cpuinfo");
    std::string name;
    for (std::string line; name.empty() && std::getline(info, line);)
        if (const size_t colon = line.find(": ");
            line.starts_with("model name") && colon != std::string::npos)
            name = line.substr(colon + 2) + ", ";
    return fmt::format("{}{} threads", name, thread_count());
}

/// Adds a section where all runs are done, and troubles where something went wrong.
void add_section(const Outcome& outcome, ReportPage& page) {
    const Experiment& experiment = *outcome.experiment;
    for (const std::string& failure : outcome.failures)
        page.troubles.push_back(fmt::format("{}: a run failed: {}", experiment.title, failure));
    for (const std::string& remark : outcome.remarks)
        page.troubles.push_back(fmt::format("{}: {}", experiment.title, remark));
    if (!outcome.complete)
        page.missing.emplace_back(experiment.name);
    if (!outcome.complete || outcome.results.empty())
        return;
    Section section{std::string(experiment.name),
                    std::string(experiment.title),
                    experiment.figures(outcome.results),
                    {}};
    section.blocks = experiment.blocks(section.figures);
    page.sections.push_back(std::move(section));
}

constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Encodes bytes as base 64 of RFC 4648.
std::string base64(std::string_view bytes) {
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kLetters[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Returns the picture as an address that an image in HTML can have.
std::string data_address(const fs::path& png) {
    std::ifstream file(png, std::ios::binary);
    return "data:image/png;base64," + base64(std::string{std::istreambuf_iterator<char>(file), {}});
}

/// Draws all plots and reads all pictures, as page_html() takes them. A plot that cannot be drawn
/// becomes a trouble of the page.
std::map<std::string, std::string> draw_all(ReportPage& page, const fs::path& folder) {
    std::map<std::string, std::string> pictures;
    for (const Section& section : page.sections)
        for (const Block& block : section.blocks)
            if (const Plot* plot = std::get_if<Plot>(&block)) {
                Result<std::string> svg = draw_plot(*plot, folder / "plots");
                pictures[plot->name] = svg ? std::move(*svg) : std::string();
                if (!svg)
                    page.troubles.push_back(svg.error().message);
            } else if (const PagePicture* picture = std::get_if<PagePicture>(&block)) {
                pictures[picture->file] = data_address(folder / picture->file);
            }
    return pictures;
}

Result<Done> write_page(ReportPage& page, const fs::path& folder) {
    for (const Section& section : page.sections)
        if (const Result<Done> saved =
                save_text(section.figures.dump(1) + "\n", folder / (section.name + ".json"));
            !saved)
            return saved;
    const std::map<std::string, std::string> pictures = draw_all(page, folder);
    if (const Result<Done> saved = save_text(page_markdown(page), folder / "summary.md"); !saved)
        return saved;
    return save_text(page_html(page, pictures), folder / "index.html");
}

Result<Done> make_folders(const ReportJob& job) {
    std::error_code error;
    fs::create_directories(fs::path(job.folder) / "plots", error);
    for (const Experiment& experiment : experiments())
        fs::create_directories(fs::path(job.folder) / "raw" / experiment.name, error);
    if (error)
        return Error{fmt::format("cannot make the folder '{}': {}", job.folder, error.message())};
    return check_writable("report", fs::path(job.folder) / "index.html");
}

} // namespace

Result<int> make_report_page(const ReportJob& job) {
    for (const Result<Done>& fine : {check_gnuplot(), make_folders(job)})
        if (!fine)
            return fine.error();
    const InterruptGuard interrupt("ending this run; those that are done are kept");
    TerminalLine progress;
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const RunSurroundings around{program, build_text(program), job.folder,
                                 [&] { return interrupt.interrupted(); },
                                 [&](const std::string& what) { progress.show(what); }};
    const Result<std::vector<Outcome>> outcomes =
        run_experiments(experiments(), job.only, job.plan, around);
    progress.clear();
    if (!outcomes)
        return outcomes.error();
    ReportPage page;
    page.subtitle = fmt::format("overcast {}, {} form, {}, {}", version_text(),
                                job.plan.quick ? "the quick" : "the full", today(), machine_text());
    for (const Outcome& outcome : *outcomes)
        add_section(outcome, page);
    if (interrupt.interrupted())
        page.troubles.emplace_back("Interrupted; the same command goes on from there.");
    if (const Result<Done> written = write_page(page, job.folder); !written)
        return written.error();
    fmt::print("{}\n", (fs::path(job.folder) / "index.html").string());
    if (!interrupt.interrupted() && !page.troubles.empty())
        return Error{fmt::format("{} things went wrong or were answered wrong; the page names "
                                 "them, the first: {}",
                                 page.troubles.size(), page.troubles[0])};
    return interrupt.interrupted() ? kExitInterrupted : kExitOk;
}

} // namespace ovc
