// SPDX-License-Identifier: Apache-2.0
// The bench: contenders do the same workloads in turn, several times, within one process.
#pragma once

#include "host/bench/contender.h"
#include "host/bench/workload.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// A contender, built.
struct Entrant {
    Contender contender;
    std::unique_ptr<Backend> backend;
};

/// One contender at one workload. Counters are those of its last call.
struct Measurement {
    size_t entrant = 0;
    size_t workload = 0;
    uint64_t rays = 0;
    uint64_t checksum = 0;
    uint64_t differing = 0;             // answers unlike the reference's
    std::optional<DistanceError> error; // of rays; none of a frame
    uint64_t flagged = 0;
    uint64_t retraced = 0;
    uint64_t passes = 0;
    uint64_t bytes_in = 0;
    std::vector<double> seconds; // from call to return, one a repeat
    std::vector<double>
        cpu_seconds; // of all threads: what is left on a machine that others use too
    std::vector<double> pass_seconds;   // of seconds, passes: ovc_statistics.seconds_pass
    std::vector<double> kernel_seconds; // the kernel alone; of a CPU tree, what a thread took
};

struct BenchEntrant {
    Contender contender;
    std::string renderer;
    ovc_statistics built{}; // before any ray
    ovc_statistics after{}; // after the last

    double build_seconds() const { return built.seconds_level1 + built.seconds_level2; }
};

struct BenchResult {
    std::string scene;
    uint64_t triangles = 0;
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t threads = 0;
    uint32_t repeats = 0;
    double seconds_import = 0;
    double load_before = 0; // processes that were running or waiting to, over the last minute
    double load_after = 0;
    bool complete = false; // false: it was interrupted
    std::vector<BenchEntrant> entrants;
    std::vector<std::string> workloads;
    std::vector<Measurement> measurements; // workload by workload, entrants in order
};

/// Says what begins: "primary, certified-fragment, 2 of 5".
using BenchObserver = std::function<void(const std::string& what)>;

/// Each entrant first does each workload once untimed, which compiles its kernels and gives its
/// checksum, then `repeats` times timed, in turn with the others. `reference` says what is right.
/// stop ends it after the call that is running. result: entrants, workloads, measurements and
/// complete are filled in, also with what there is when it ends early; measurements without a timed
/// call are left out. Error: a contender fails.
Result<Done> run_contenders(std::vector<Entrant>& entrants, std::vector<Workload>& workloads,
                            Backend& reference, uint32_t repeats, const StopRequest& stop,
                            const BenchObserver& observe, BenchResult& result);

/// A sentence about certified answers that are not the reference's; empty: there is none.
std::string wrong_answers(const BenchResult& result);

} // namespace ovc
