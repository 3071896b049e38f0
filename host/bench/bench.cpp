// SPDX-License-Identifier: Apache-2.0
// Calls the contenders in rounds and takes the time of each call.
#include "host/bench/bench.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "host/terminal/process_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc {

namespace {

struct Answers {
    std::vector<uint64_t> names;
    std::vector<double> distances; // empty for a frame
};

Answers answers_of(const Workload& workload) {
    return {workload.answers(), workload.distances()};
}

uint64_t count_differing(std::span<const uint64_t> a, std::span<const uint64_t> b) {
    assert(a.size() == b.size()); // both are answers to the same workload
    uint64_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i];
    return count;
}

/// Returns the seconds of the kernel alone, without moving rays and answers. For a tree on the CPU
/// this is the kernel's share of the call, in CPU seconds a thread: it equals wall time on an idle
/// machine and is hardly disturbed on a busy one. The kernel time of a software renderer is CPU
/// time already (gpu/driver/driver_threads.h).
double kernel_alone(const ovc_statistics& before, const ovc_statistics& after, double seconds,
                    double cpu_seconds) {
    const double kernel = after.seconds_kernel - before.seconds_kernel;
    if (after.seconds_pass > before.seconds_pass)
        return kernel;
    const double share = kernel > 0 ? kernel / seconds : 1;
    return share * cpu_seconds / double(thread_count());
}

/// Runs the workload once and notes its counters in m, and its seconds where `timed`.
Result<Done> call(Workload& workload, Backend& backend, bool timed, Measurement& m) {
    const ovc_statistics before = backend.statistics();
    const double cpu_before = process_cpu_seconds();
    const Stopwatch watch;
    const Result<uint64_t> rays = workload.run(backend);
    const double seconds = watch.seconds();
    const double cpu_seconds = process_cpu_seconds() - cpu_before;
    if (!rays)
        return rays.error();
    const ovc_statistics after = backend.statistics();
    m.rays = *rays;
    m.flagged = after.flagged - before.flagged;
    m.retraced = after.retraced - before.retraced;
    m.passes = after.passes - before.passes;
    m.bytes_in = after.bytes_in - before.bytes_in;
    if (timed) {
        m.seconds.push_back(seconds);
        m.cpu_seconds.push_back(cpu_seconds);
        m.pass_seconds.push_back(after.seconds_pass - before.seconds_pass);
        m.kernel_seconds.push_back(kernel_alone(before, after, seconds, cpu_seconds));
    }
    return Done{};
}

class Bench {
public:
    Bench(std::vector<Entrant>& entrants, std::vector<Workload>& workloads, const Soup& soup,
          Backend& reference, const StopRequest& stop, const BenchObserver& observe)
        : entrants_(entrants),
          workloads_(workloads),
          soup_(soup),
          reference_(reference),
          stop_(stop),
          observe_(observe) {
        for (size_t w = 0; w < workloads.size(); ++w)
            for (size_t e = 0; e < entrants.size(); ++e)
                measurements.push_back({.entrant = e, .workload = w});
    }

    /// Returns false if the run was stopped.
    Result<bool> warm_up() {
        Answers right;
        for (Measurement& m : measurements) {
            if (m.entrant == 0) {
                Result<Done> answered = ask_reference(m.workload, right);
                if (!answered)
                    return answered.error();
            }
            const Result<bool> done = step(m, /* timed= */ false, "first call");
            if (!done || !*done)
                return done;
            const Answers answers = answers_of(workloads_[m.workload]);
            m.checksum = checksum(answers.names);
            m.differing = count_differing(answers.names, right.names);
            m.verdicts = workloads_[m.workload].judged(soup_, right.names, right.distances);
            if (!right.distances.empty())
                m.error = distance_error(answers.distances, right.distances);
        }
        return true;
    }

    Result<bool> repeat(uint32_t repeats) {
        for (uint32_t round = 1; round <= repeats; ++round)
            for (Measurement& m : measurements) {
                const Result<bool> done =
                    step(m, /* timed= */ true, fmt::format("{} of {}", round, repeats));
                if (!done || !*done)
                    return done;
            }
        return true;
    }

    std::vector<Measurement> measurements;

private:
    Result<Done> ask_reference(size_t workload, Answers& right) {
        const Result<uint64_t> done = workloads_[workload].run(reference_);
        if (!done)
            return done.error();
        right = answers_of(workloads_[workload]);
        return Done{};
    }

    /// Returns false if the run was stopped before or during the call. Such a call is not kept,
    /// because it may have been cut short.
    Result<bool> step(Measurement& m, bool timed, const std::string& which) {
        if (stop_())
            return false;
        const Entrant& entrant = entrants_[m.entrant];
        Workload& workload = workloads_[m.workload];
        observe_(fmt::format("{}, {}, {}", workload.name, entrant.contender.label(), which));
        Measurement next = m;
        const Result<Done> done = call(workload, *entrant.backend, timed, next);
        if (!done)
            return Error{fmt::format("{}: {}", entrant.contender.label(), done.error().message)};
        if (stop_())
            return false;
        m = std::move(next);
        return true;
    }

    std::vector<Entrant>& entrants_;
    std::vector<Workload>& workloads_;
    const Soup& soup_;
    Backend& reference_;
    const StopRequest& stop_;
    const BenchObserver& observe_;
};

} // namespace

Result<Done> run_contenders(std::vector<Entrant>& entrants, std::vector<Workload>& workloads,
                            const Soup& soup, Backend& reference, uint32_t repeats,
                            const StopRequest& stop, const BenchObserver& observe,
                            BenchResult& result) {
    for (const Entrant& entrant : entrants)
        result.entrants.push_back(
            {entrant.contender, entrant.backend->renderer(), entrant.backend->statistics(), {}});
    for (const Workload& workload : workloads)
        result.workloads.push_back(workload.name);
    result.repeats = repeats;

    Bench bench(entrants, workloads, soup, reference, stop, observe);
    const Result<bool> warm = bench.warm_up();
    if (!warm)
        return warm.error();
    const Result<bool> done = *warm ? bench.repeat(repeats) : warm;
    if (!done)
        return done.error();
    for (size_t e = 0; e < entrants.size(); ++e)
        result.entrants[e].after = entrants[e].backend->statistics();
    result.complete = *done && !stop();
    result.measurements = std::move(bench.measurements);
    std::erase_if(result.measurements, [](const Measurement& m) { return m.seconds.empty(); });
    return Done{};
}

std::string wrong_answers(const BenchResult& result) {
    for (const Measurement& m : result.measurements)
        if (const Contender& contender = result.entrants[m.entrant].contender;
            contender.certified() && m.differing > 0)
            return fmt::format("{} of {} answered {} wrong: {} answers unlike double precision's",
                               result.scene, contender.label(), result.workloads[m.workload],
                               m.differing);
    return "";
}

} // namespace ovc
