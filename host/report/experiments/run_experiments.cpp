// SPDX-License-Identifier: Apache-2.0
// Executes one run after another and tells how much time is left.
#include "host/report/experiments/run_experiments.h"

#include "host/bench/programs/run_program.h"
#include "host/output/output.h"
#include "host/report/experiments/leaf_patches.h"
#include "host/report/experiments/raw_results.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

namespace ovc {

namespace {

namespace fs = std::filesystem;

/// A run may take kPatience times its expected time, and kMinLimit seconds in any case, because
/// machines differ and are shared.
constexpr double kPatience = 20;
constexpr double kMinLimit = 300;

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

std::vector<std::string> words_of(const ReportRun& run, const std::string& program,
                                  const std::string& folder) {
    std::vector<std::string> words;
    if (!run.variables.empty()) {
        words.push_back("env");
        words.insert(words.end(), run.variables.begin(), run.variables.end());
    }
    words.push_back(program);
    for (std::string word : run.words) {
        if (const size_t at = word.find("{}"); at != std::string::npos)
            word.replace(at, 2, folder);
        words.push_back(std::move(word));
    }
    return words;
}

Json read_json(const fs::path& path) {
    std::ifstream file(path);
    return Json::parse(file, nullptr, /* allow_exceptions= */ false);
}

Result<std::string> read_bytes(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    return bytes.empty() ? Result<std::string>(Error{path.string() + " is not there"})
                         : std::move(bytes);
}

/// Tells how far the whole report is, in expected seconds.
class Clock {
public:
    void expect(double seconds) { expected_ += seconds, ++runs_; }
    void done(const ReportRun& run, double seconds) {
        expected_done_ += run.seconds;
        taken_ += seconds;
        ++runs_done_;
    }
    /// Returns "2 of 9 runs, 3 min left", estimated from the time that runs took so far.
    std::string text() const {
        const double pace = expected_done_ > 0 ? taken_ / expected_done_ : 1;
        return fmt::format("{} of {} runs, {}", runs_done_ + 1, runs_,
                           time_left(pace * (expected_ - expected_done_)));
    }

private:
    double expected_ = 0, expected_done_ = 0, taken_ = 0;
    size_t runs_ = 0, runs_done_ = 0;
};

class Runner {
public:
    explicit Runner(const RunSurroundings& around) : around_(around) {}

    void expect(const Experiment& experiment, std::span<const ReportRun> runs) {
        for (const ReportRun& run : runs)
            if (!load_raw(path_of(experiment, run), run))
                clock_.expect(run.seconds);
    }

    /// Returns whether the run is done: earlier, or now where it `may_run`. Returns false where it
    /// was stopped.
    Result<bool> go(const ReportRun& run, bool may_run, Outcome& outcome) {
        const Experiment& experiment = *outcome.experiment;
        const fs::path path = path_of(experiment, run);
        if (std::optional<RawResult> there = load_raw(path, run)) {
            outcome.results.push_back(std::move(*there));
            return true;
        }
        if (!may_run || around_.stop())
            return false;
        around_.show(fmt::format("{}: {}, {}", experiment.name, run.key, clock_.text()));
        const RunFolder own(fs::path(path).replace_extension(".part"));
        if (own.error())
            return Error{fmt::format("cannot make the folder '{}': {}", own.path().string(),
                                     own.error().message())};
        const Result<ProgramEnd> end =
            watch_program(words_of(run, around_.program, own.path()),
                          std::max(kMinLimit, kPatience * run.seconds), around_.stop);
        if (!end)
            return end.error();
        if (end->stopped)
            return false;
        clock_.done(run, end->seconds);
        return keep(run, *end, own.path() / run.result, outcome);
    }

private:
    fs::path path_of(const Experiment& experiment, const ReportRun& run) const {
        return raw_path(around_.folder, experiment, run, around_.build);
    }

    /// Keeps the result of a command that ended by itself, also where it found something wrong and
    /// says so. The result of a command that was killed does not count.
    Result<bool> keep(const ReportRun& run, const ProgramEnd& end, const fs::path& left,
                      Outcome& outcome) {
        RawResult raw{run, {}};
        if (end.exit_code == 0 || end.exit_code == 1)
            raw.result = read_json(left);
        if (end.exit_code == 1 && run.may_refuse && !raw.result.is_object()) {
            raw.result = {{"refused", end.said}};
            return keep(std::move(raw), end.seconds, outcome);
        }
        if (end.too_long || !raw.result.is_object()) {
            outcome.failures.push_back(fmt::format(
                "{}: {}", run.key,
                end.too_long ? fmt::format("ended after {:.0f} s", end.seconds) : end.said));
            return true;
        }
        if (const Result<Done> kept = keep_picture(raw, left.parent_path(), *outcome.experiment);
            !kept) {
            outcome.failures.push_back(fmt::format("{}: {}", run.key, kept.error().message));
            return true;
        }
        if (end.exit_code == 0)
            return keep(std::move(raw), end.seconds, outcome);
        outcome.remarks.push_back(fmt::format("{}: {}", run.key, end.said));
        outcome.results.push_back(std::move(raw)); // not saved, so that it runs again next time
        return true;
    }

    /// Writes the run's picture beside its result, from an .exr file the patches of leaves.
    Result<Done> keep_picture(RawResult& raw, const fs::path& left, const Experiment& experiment) {
        if (raw.run.picture.empty())
            return Done{};
        const fs::path from = left / raw.run.picture;
        const Result<std::string> png =
            from.extension() == ".exr" ? leaf_patches(from) : read_bytes(from);
        if (!png)
            return png.error();
        const fs::path to = picture_path(path_of(experiment, raw.run));
        raw.picture = picture_in_report(to);
        return save_text(*png, to);
    }

    Result<bool> keep(RawResult raw, double seconds, Outcome& outcome) {
        if (const Result<Done> saved =
                save_raw(path_of(*outcome.experiment, raw.run), raw, around_.build, seconds);
            !saved)
            return saved.error();
        outcome.results.push_back(std::move(raw));
        return true;
    }

    const RunSurroundings& around_;
    Clock clock_;
};

std::vector<ReportRun> runs_of(const Experiment& experiment, const ReportPlan& plan) {
    std::vector<ReportRun> runs = experiment.runs(plan);
    if (!plan.size.empty())
        for (ReportRun& run : runs)
            for (size_t i = 1; i < run.words.size(); ++i)
                if (run.words[i - 1] == "--size")
                    run.words[i] = plan.size;
    return runs;
}

} // namespace

Result<std::vector<Outcome>> run_experiments(std::span<const Experiment> experiments,
                                             std::string_view chosen, const ReportPlan& plan,
                                             const RunSurroundings& around) {
    const auto is_chosen = [&](const Experiment& one) {
        return chosen.empty() || one.name == chosen;
    };
    Runner runner(around);
    for (const Experiment& experiment : experiments)
        if (is_chosen(experiment))
            runner.expect(experiment, runs_of(experiment, plan));
    std::vector<Outcome> outcomes;
    for (const Experiment& experiment : experiments) {
        Outcome& outcome = outcomes.emplace_back();
        outcome.experiment = &experiment;
        outcome.complete = true;
        for (const ReportRun& run : runs_of(experiment, plan)) {
            const Result<bool> done = runner.go(run, is_chosen(experiment), outcome);
            if (!done)
                return done.error();
            outcome.complete = outcome.complete && *done;
        }
    }
    return outcomes;
}

} // namespace ovc
