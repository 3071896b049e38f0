// SPDX-License-Identifier: Apache-2.0
// Executes one run after another, notes the machine's load beside each, and tells how much time is
// left.
#include "host/report/experiments/run_experiments.h"

#include "core/system/parallel.h"
#include "host/bench/programs/run_program.h"
#include "host/doctor/machine_load.h"
#include "host/output/leaf_patches.h"
#include "host/output/output.h"
#include "host/report/experiments/experiment_file.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace ovc {

namespace {

namespace fs = std::filesystem;

/// A run may take kPatience times its expected time, and kMinLimit seconds in any case, because
/// machines differ and are shared.
constexpr double kPatience = 20;
constexpr double kMinLimit = 300;

constexpr double kQuiet = 0.1;      // of all cores, for other programs
constexpr double kForRepeats = 0.1; // of the time that all is expected to take
constexpr int kMaxAttempts = 3;

/// The empty folder of a run, which the destructor removes.
class RunFolder {
public:
    explicit RunFolder(fs::path path) : path_(std::move(path)) {
        fs::remove_all(path_, error_);
        fs::create_directories(path_, error_);
    }
    ~RunFolder() { fs::remove_all(path_, error_); }
    RunFolder(const RunFolder&) = delete;
    RunFolder& operator=(const RunFolder&) = delete;

    const fs::path& path() const { return path_; }
    const std::error_code& error() const { return error_; }

private:
    fs::path path_;
    std::error_code error_;
};

Words in_folder(Words words, const std::string& folder) {
    for (std::string& word : words)
        if (const size_t at = word.find("{}"); at != std::string::npos)
            word.replace(at, 2, folder);
    return words;
}

/// Returns the words of the run's own command. Open MPI refuses root, and more processes than
/// cores, unless it is told otherwise.
Words command_words(const ReportRun& run, const std::string& program, const std::string& folder) {
    Words words = {"env"};
    words = with_words(std::move(words), run.variables);
    if (run.ranks > 0)
        words = with_words(std::move(words),
                           {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                            "OMPI_MCA_mpi_yield_when_idle=1", "mpirun", "--oversubscribe",
                            "--bind-to", "none", "-n", std::to_string(run.ranks)});
    words.push_back(program);
    return in_folder(with_words(std::move(words), run.words), folder);
}

Json read_json(const fs::path& path) {
    std::ifstream file(path);
    return Json::parse(file, nullptr, /* allow_exceptions= */ false);
}

Result<std::string> png_of(const fs::path& path) {
    if (path.extension() == ".exr")
        return leaf_patches(path);
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return bytes.empty() ? Result<std::string>(Error{path.string() + " is not there"})
                         : std::move(bytes);
}

uint64_t bytes_below(const fs::path& folder) {
    uint64_t bytes = 0;
    std::error_code error;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder, error))
        bytes += file.is_regular_file() ? file.file_size() : 0;
    return bytes;
}

/// An attempt at a run: how its program ended, what it left, and what else went on.
struct Attempt {
    ProgramEnd end;
    Json result;
    std::string png; // empty: none
    Json trouble;    // a sentence, or null
    uint64_t kernel_bytes = 0;
    double load_before = 0, load_after = 0;
    double others = 0; // cores
};

class Runner {
public:
    explicit Runner(const RunSurroundings& around) : around_(around) {}

    void expect(const ReportRun& run) {
        expected_ += run.seconds, ++runs_;
        for_repeats_ = kForRepeats * expected_;
    }

    /// Returns false where the run was stopped.
    Result<bool> go(const Experiment& experiment, const ReportRun& run, ExperimentFile& file) {
        around_.show(fmt::format("{}: {}, {} of {} runs, {}", experiment.name, run.key,
                                 runs_done_ + 1, runs_, time_left(pace() * left())));
        std::optional<Attempt> best;
        int attempts = 0;
        do {
            Result<Attempt> one = attempt(run);
            if (!one)
                return one.error();
            if (one->end.stopped)
                return false;
            ++attempts;
            if (attempts > 1)
                for_repeats_ -= one->end.seconds;
            if (!best || (one->trouble.is_null() && one->others < best->others))
                best = std::move(*one);
        } while (run.timed && !is_quiet(*best) && best->trouble.is_null() &&
                 attempts < kMaxAttempts && best->end.seconds <= for_repeats_);
        expected_done_ += run.seconds, taken_ += best->end.seconds, ++runs_done_;
        return keep(run, *best, attempts, file);
    }

private:
    double pace() const { return expected_done_ > 0 ? taken_ / expected_done_ : 1; }
    double left() const { return expected_ - expected_done_; }
    static bool is_quiet(const Attempt& attempt) {
        return attempt.others <= kQuiet * double(thread_count());
    }

    Result<Attempt> attempt(const ReportRun& run) {
        const RunFolder own(around_.folder / "part");
        if (own.error())
            return Error{fmt::format("cannot make the folder '{}': {}", own.path().string(),
                                     own.error().message())};
        Attempt attempt;
        attempt.load_before = load_average();
        if (!run.before.empty()) {
            const Result<ProgramEnd> first =
                execute(with_words({around_.program}, in_folder(run.before, own.path())), run);
            if (!first)
                return first.error();
            if (first->exit_code != 0)
                return failed(*first);
        }
        const OtherLoad others;
        const Result<ProgramEnd> end =
            execute(command_words(run, around_.program, own.path()), run);
        if (!end)
            return end.error();
        attempt.end = *end;
        attempt.others = others.cores(end->cpu_seconds);
        attempt.load_after = load_average();
        attempt.kernel_bytes = bytes_below(own.path() / "kernels");
        read(run, own.path(), attempt);
        return attempt;
    }

    Result<ProgramEnd> execute(const Words& words, const ReportRun& run) const {
        return watch_program(words, std::max(kMinLimit, kPatience * run.seconds), around_.stop);
    }

    static Attempt failed(const ProgramEnd& end) {
        Attempt attempt;
        attempt.end = end;
        attempt.trouble =
            end.too_long ? fmt::format("ended after {:.0f} s", end.seconds) : end.said;
        return attempt;
    }

    /// Takes the result of a command that ended by itself, also where it found something wrong and
    /// says so. The result of a command that was killed does not count.
    static void read(const ReportRun& run, const fs::path& folder, Attempt& attempt) {
        const ProgramEnd end = attempt.end;
        if (end.exit_code == 0 || end.exit_code == 1)
            attempt.result = read_json(folder / run.result);
        if (end.exit_code == 1 && run.may_refuse && !attempt.result.is_object()) {
            attempt.result = {{"refused", end.said}};
            return;
        }
        if (end.too_long || !attempt.result.is_object())
            attempt = failed(end);
        else if (end.exit_code != 0 && !run.judges)
            attempt.trouble = end.said;
        if (run.picture.empty() || !attempt.trouble.is_null())
            return;
        Result<std::string> png = png_of(folder / run.picture);
        if (png)
            attempt.png = std::move(*png);
        else
            attempt.trouble = png.error().message;
    }

    static Result<bool> keep(const ReportRun& run, Attempt& best, int attempts,
                             ExperimentFile& file) {
        Json one = {{"key", run.key},
                    {"command", command_of(run)},
                    {"seconds", best.end.seconds},
                    {"cpu_seconds", best.end.cpu_seconds},
                    {"attempts", attempts},
                    {"load",
                     {{"before", best.load_before},
                      {"others_during", best.others},
                      {"after", best.load_after}}},
                    {"quiet", is_quiet(best)},
                    {"trouble", best.trouble}};
        if (best.kernel_bytes > 0)
            one["kernel_bytes"] = best.kernel_bytes;
        if (!best.png.empty()) {
            const fs::path path = file.picture_path(run);
            if (const Result<Done> saved = save_text(best.png, path); !saved)
                return saved.error();
            one["picture"] = (path.parent_path().filename() / path.filename()).string();
        }
        one["result"] = best.result.is_object() ? std::move(best.result) : Json(nullptr);
        const Result<Done> kept = file.keep(std::move(one));
        return kept ? Result<bool>(true) : kept.error();
    }

    const RunSurroundings& around_;
    double expected_ = 0, expected_done_ = 0, taken_ = 0, for_repeats_ = 0;
    size_t runs_ = 0, runs_done_ = 0;
};

/// Tables of `overcast bench` that draw squares, of the height that is asked for.
bool draws_squares(const ReportRun& run) {
    return std::ranges::any_of(run.words, [](const std::string& word) {
        return word == "--pictures" || word == "--programs" || word == "--bars";
    });
}

std::vector<ReportRun> runs_of(const Experiment& experiment, const ReportPlan& plan) {
    std::vector<ReportRun> runs = experiment.runs(plan);
    if (plan.size.empty())
        return runs;
    const std::string height = plan.size.substr(plan.size.find('x') + 1);
    for (ReportRun& run : runs)
        for (size_t i = 1; i < run.words.size(); ++i)
            if (run.words[i - 1] == "--size")
                run.words[i] = draws_squares(run) ? height + "x" + height : plan.size;
    return runs;
}

} // namespace

Result<std::vector<std::string>> run_experiments(std::span<const Experiment> experiments,
                                                 std::string_view chosen, const ReportPlan& plan,
                                                 const RunSurroundings& around) {
    Runner runner(around);
    struct Part {
        const Experiment* experiment;
        std::vector<ReportRun> runs;
        ExperimentFile file;
    };
    std::vector<Part> parts;
    for (const Experiment& one : experiments)
        if (chosen.empty() || one.name == chosen)
            parts.push_back({&one, runs_of(one, plan), {around.folder, one, plan, around.build}});
    for (const Part& part : parts)
        for (const ReportRun& run : part.runs)
            if (!part.file.has(run))
                runner.expect(run);
    std::vector<std::string> troubles;
    for (Part& part : parts) {
        for (const ReportRun& run : part.runs) {
            if (part.file.has(run))
                continue;
            const Result<bool> done =
                around.stop() ? false : runner.go(*part.experiment, run, part.file);
            if (!done)
                return done.error();
            if (!*done)
                break;
        }
        if (const Result<bool> finished = part.file.finish(part.runs); !finished)
            return finished.error();
        for (std::string& trouble : part.file.troubles())
            troubles.push_back(std::move(trouble));
    }
    return troubles;
}

} // namespace ovc
