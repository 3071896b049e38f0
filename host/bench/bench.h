// SPDX-License-Identifier: Apache-2.0
// The bench: contenders take turns at the same workloads, several times, within one process.
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

/// A contender that has been built.
struct Entrant {
    Contender contender;
    std::unique_ptr<Backend> backend;
};

/// The calls of one contender at one workload. Counters are those of its last call.
struct Measurement {
    size_t entrant = 0;  // index in BenchResult::entrants
    size_t workload = 0; // index in BenchResult::workloads
    uint64_t rays = 0;
    uint64_t checksum = 0;
    uint64_t differing = 0;             // answers that differ from the reference's
    std::optional<DistanceError> error; // a frame has none
    Verdicts verdicts;                  // on them; of a frame's pixels there are none
    uint64_t flagged = 0;
    uint64_t retraced = 0;
    uint64_t passes = 0;
    uint64_t bytes_in = 0;
    // One value for each timed call:
    std::vector<double> seconds;        // wall clock, from call to return
    std::vector<double> cpu_seconds;    // of all threads; other programs disturb it less
    std::vector<double> pass_seconds;   // the part of `seconds` in ovc_statistics.seconds_pass
    std::vector<double> kernel_seconds; // the kernel alone; CPU seconds a thread for a CPU tree
};

struct BenchEntrant {
    Contender contender;
    std::string renderer;
    ovc_statistics built{}; // before the first ray
    ovc_statistics after{}; // after the last ray

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
    double load_before = 0; // the system's load average over one minute
    double load_after = 0;
    bool complete = false; // false: the run was interrupted
    std::vector<BenchEntrant> entrants;
    std::vector<std::string> workloads;
    std::vector<Measurement> measurements; // by workload, then in the order of entrants
};

/// Is told what begins: "primary, certified-fragment, 2 of 5".
using BenchObserver = std::function<void(const std::string& what)>;

/// Runs each workload with each entrant: once untimed, which compiles kernels and yields checksums,
/// then `repeats` times timed, in turn with the others. `reference` answers first, and entrants'
/// answers are compared with its answers; the soup, which all have, judges those that differ. When
/// stop() returns true, the run ends after the current call, whose result is dropped. Fills in
/// entrants, workloads, repeats, measurements and complete of `result`, in a run that was stopped
/// with the measurements so far; measurements without a timed call are left out. Error: the
/// reference or a contender fails.
Result<Done> run_contenders(std::vector<Entrant>& entrants, std::vector<Workload>& workloads,
                            const Soup& soup, Backend& reference, uint32_t repeats,
                            const StopRequest& stop, const BenchObserver& observe,
                            BenchResult& result);

/// Returns a sentence about the first certified contender whose answers differ from the
/// reference's, or an empty string where all agree.
std::string wrong_answers(const BenchResult& result);

} // namespace ovc
