// SPDX-License-Identifier: Apache-2.0
// overcast bench: times the plugin, certified and fast, and its peers in turn on the same rays. Its
// other tables are the performance targets (--bars), whole programs, sweeps and pictures.
#include "host/arguments/log_arguments.h"
#include "host/backend/plugin_loader.h"
#include "host/bench/bars/run_bars.h"
#include "host/bench/bench_arguments.h"
#include "host/bench/bench_text.h"
#include "host/bench/pictures/sample_pictures.h"
#include "host/bench/pictures/tessellation.h"
#include "host/bench/scene_bench.h"
#include "host/bench/sweep.h"
#include "host/command/command.h"
#include "host/output/output.h"
#include "host/ranks/ranks.h"
#include "host/scene/scene_source.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"
#include "host/terminal/terminal_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <set>

namespace ovc {

namespace {

constexpr const char* kBenchExamples = R"(Examples:
  overcast bench dragon.ply
      camera, shadow and bounced rays, and a frame: all contenders, five times in turn
  overcast bench knot plants --only certified,embree --size 512x512 --repeats 11
      two scenes; the plugin certified, by both kernels, and Embree in all its qualities
  overcast bench --only certified-compute --leaves 1,8,32,128
      what leaves cost: each row says its time to the first row's
  overcast bench fractal-100 --only certified-compute --instances baked,shared
      what it costs that instances share their mesh's pages
  overcast bench plants --only certified --resident all,30%
      what a budget costs that holds 30 % of the pages
  overcast bench scan.ovc --host-memory 2G --repeats 3
      a scene larger than memory: the contenders that read it as they need it
  overcast bench dragon.ply --bars --json bars.json
      the table of what is promised: kernels, builds, import, memory, whole programs
  overcast bench dragon.ply --programs --size 512x512
      overcast render beside povray and tachyon, where they are installed
  overcast bench plants --sweep budget
      what a budget of 5 % to 100 % of the pages costs; rays, triangles, leaves likewise
  overcast bench sphere-5 --pictures samples --most 16
      time against the error of a picture with 1, 4 and 16 samples a pixel, povray and tachyon too
  overcast bench --pictures tolerance
      triangles and time against the distance from exact spheres, cones and tori
  overcast bench dragon.ply --json - | jq '.scenes[].measurements[] | {contender, call_seconds}'

--bars says of each line from where to where the median of more turns lies, from five --repeats on
with a probability of 90 %. It exits with 1 where a line fails, and judges no line whose bar lies
between the two.

All contenders answer the same rays with the same number of threads, and are in memory at once.
Interrupted with Ctrl-C, it prints what it has and exits with 2.)";

/// Logs to standard error, each sentence once: every contender of the plugin opens the same device,
/// which repeats what it says.
class QuietLog {
public:
    explicit QuietLog(LogLevel max_level) : log_(standard_error_log(max_level)) {}
    LogSink sink() {
        return [this](LogLevel level, const std::string& message) {
            const std::lock_guard lock(mutex_); // a device's thread may call
            if (said_.insert(message).second)
                log_(level, message);
        };
    }

private:
    LogSink log_;
    std::mutex mutex_;
    std::set<std::string> said_;
};

/// Prints a table, unless standard output is taken by JSON.
void show(const BenchJob& job, const std::string& table) {
    if (job.json == "-")
        return;
    print_lines(table);
    std::fflush(stdout);
}

Result<Done> save(const BenchJob& job, const std::string& json) {
    if (job.json.empty())
        return Done{};
    if (job.json != "-")
        return save_text(json, job.json);
    fmt::print("{}", json);
    return Done{};
}

/// Says which contenders do not take part, and why.
void tell_of_left_out(const BenchJob& job, const LogSink& log) {
    if (job.host_bytes == 0)
        return;
    std::vector<std::string> names;
    for (const Contender& contender : job.beyond)
        names.push_back(contender.label());
    say(log, LogLevel::Info,
        fmt::format("--host-memory: left out, for they hold a scene in memory: {}the CPU KD-tree "
                    "that judges. Answers are compared with those of {}; {} share the budget",
                    names.empty() ? "" : fmt::format("{}, and ", fmt::join(names, ", ")),
                    job.contenders.front().label(),
                    job.contenders.size() == 1
                        ? "it and the scene"
                        : fmt::format("{} contenders", job.contenders.size())));
}

Result<Done> bench_contenders(const BenchJob& job, const BenchSurroundings& around) {
    std::vector<BenchResult> results;
    tell_of_left_out(job, around.log);
    for (const std::string& source : job.scenes) {
        if (around.stop())
            break;
        SceneBench bench;
        bench.scene = source;
        bench.asked.size = job.size;
        bench.asked.only = job.workloads;
        bench.asked.float_rays = job.float_rays;
        bench.repeats = job.repeats;
        bench.contenders = job.contenders;
        bench.device = job.device;
        bench.ranks_own = job.ranks_own;
        const Ranks* const ranks = Ranks::of_run();
        if (ranks)
            bench.asked.frame = false; // its calls are more than plain rays
        bench.host_bytes = job.host_bytes;
        Result<BenchResult> result = bench_scene(bench, around);
        if (!result)
            return result.error();
        if (ranks && !ranks->is_first())
            continue;
        show(job, (results.empty() ? "" : "\n") + bench_table(*result));
        results.push_back(std::move(*result));
    }
    if (const Ranks* const ranks = Ranks::of_run(); ranks && !ranks->is_first())
        return Done{};
    if (const Result<Done> saved = save(job, bench_json(results)); !saved)
        return saved;
    for (const BenchResult& result : results)
        if (const std::string wrong = wrong_answers(result); !wrong.empty())
            return Error{wrong};
    return Done{};
}

Result<Done> bench_bars(const BenchJob& job, const BenchSurroundings& around) {
    const Result<BarsResult> r =
        run_bars({job.scenes[0], job.device, job.size.width, job.repeats, job.scene_alone}, around);
    if (!r)
        return r.error();
    show(job, bars_table(r->bars));
    if (r->programs)
        show(job, "\n" + programs_table(*r->programs));
    for (const BenchResult& scene : r->scenes)
        show(job, "\n" + bench_table(scene));
    const Result<Done> saved =
        save(job, bars_json(r->bars, r->scenes, r->programs ? &*r->programs : nullptr));
    if (const std::string failed = failed_bars(r->bars); saved && r->complete && !failed.empty())
        return Error{failed};
    return saved;
}

Result<Done> bench_programs(const BenchJob& job, const BenchSurroundings& around) {
    const Result<ProgramsResult> r =
        run_programs(job.scenes[0], job.size.width, job.repeats, around);
    if (!r)
        return r.error();
    show(job, programs_table(*r));
    return save(job, programs_json(*r));
}

Result<Done> bench_sweep(const BenchJob& job, const BenchSurroundings& around) {
    const Result<Sweep> sweep = run_sweep(job, around);
    if (!sweep)
        return sweep.error();
    show(job, sweep_table(*sweep));
    return save(job, sweep_json(*sweep));
}

Result<Done> bench_samples(const BenchJob& job, const BenchSurroundings& around) {
    const Result<SamplePictures> r = run_sample_pictures(
        {job.scenes[0], job.size.width, uint32_t(job.most), job.repeats}, around);
    if (!r)
        return r.error();
    show(job, sample_pictures_table(*r));
    return save(job, sample_pictures_json(*r));
}

Result<Done> bench_tolerance(const BenchJob& job, const BenchSurroundings& around) {
    const Result<Tessellation> r =
        run_tessellation({job.size.width, job.repeats, job.device}, around);
    if (!r)
        return r.error();
    show(job, tessellation_table(*r));
    return save(job, tessellation_json(*r));
}

/// All contenders share a process, and so the width of vectors. Fragment kernels need the narrower.
void prepare_process_for(const std::vector<Contender>& contenders) {
    const auto any = [&](const auto& matches) { return std::ranges::any_of(contenders, matches); };
    const bool any_thesis = any([](const Contender& c) { return c.kind == ContenderKind::Thesis; });
    const bool any_fragment =
        any([](const Contender& c) { return c.on_gpu() && c.kernel == OVC_KERNEL_FRAGMENT; });
    prepare_process(any_thesis || any_fragment ? OVC_KERNEL_FRAGMENT : OVC_KERNEL_AUTO);
    if (any_thesis)
        prepare_process(OVC_KERNEL_FRAGMENT, kThesis);
}

Result<Done> bench_kind(const BenchJob& job, const BenchSurroundings& around) {
    if (job.kind == BenchKind::Contenders)
        prepare_process_for(job.contenders);
    else
        prepare_process(OVC_KERNEL_AUTO);
    switch (job.kind) {
    case BenchKind::Bars:
        return bench_bars(job, around);
    case BenchKind::Programs:
        return bench_programs(job, around);
    case BenchKind::Sweep:
        return bench_sweep(job, around);
    case BenchKind::Pictures:
        return job.pictures == PicturesBy::Samples ? bench_samples(job, around)
                                                   : bench_tolerance(job, around);
    case BenchKind::Contenders:
        break;
    }
    return bench_contenders(job, around);
}

Result<int> bench(const BenchJob& job, LogLevel level) {
    const InterruptGuard interrupt;
    const StopRequest stop = [&] { return interrupt.interrupted(); };
    TerminalLine progress;
    QuietLog log(level);
    const LogSink sink = log.sink();
    if (const Result<Done> done = bench_kind(job, {stop, sink, progress}); !done)
        return done.error();
    if (!stop())
        return kExitOk;
    print_message("interrupted; what was measured so far is kept");
    return kExitInterrupted;
}

class Bench final : public Subcommand {
public:
    void add_to(CLI::App& app) override {
        app.description("Times how rays are answered: the plugin certified and fast, and its "
                        "peers.");
        words_.add_to(app);
        log_.add_to(app);
        app.footer(kBenchExamples);
    }

    Result<int> run() override {
        const Result<LogLevel> level = log_.resolve();
        if (!level)
            return level.error();
        const Result<BenchJob> job = understand_bench(words_);
        if (!job)
            return job.error();
        if (Ranks::are_there() && job->kind != BenchKind::Contenders)
            return Error{"of the tables of bench, several processes share the work of contenders "
                         "alone"};
        if (const Result<Done> opened = Ranks::open("bench", /* timeout_seconds= */ 0); !opened)
            return opened.error();
        const Ranks* const ranks = Ranks::of_run();
        return bench(*job, ranks && !ranks->is_first() ? LogLevel::Error : *level);
    }

private:
    BenchWords words_;
    LogArguments log_{LogLevel::Info};
};

} // namespace

std::unique_ptr<Subcommand> make_bench() {
    return std::make_unique<Bench>();
}

} // namespace ovc
