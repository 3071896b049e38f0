// SPDX-License-Identifier: Apache-2.0
// Turns the command line of `overcast bench` into a job.
#pragma once

#include "host/arguments/arguments.h"
#include "host/bench/contender.h"

#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// The kind of bench: contenders over scenes, the table of bars, whole programs, how cost
/// grows, or what pictures cost and how wrong they are.
enum class BenchKind { Contenders, Bars, Programs, Sweep, Pictures };
enum class SweepOver { Rays, Triangles, Instances, Leaves, Budget };
enum class PicturesBy { Samples, Tolerance };

/// The command line as the user gave it.
struct BenchWords {
    std::vector<std::string> scenes;
    bool bars = false;
    bool scene_alone = false;
    bool programs = false;
    std::string sweep;
    std::string pictures;
    std::string most;
    std::string only;
    std::string workloads;
    bool float_rays = false;
    std::string size; // empty: 1024x1024; 512x512 for programs, 256x256 for pictures
    std::string repeats = "5";
    std::string leaves;
    std::string instances;
    std::string gpu_memory;
    std::string host_memory;
    std::string resident;
    std::string device;
    std::string kernel_variant;
    std::string ranks_own;
    std::string json;

    void add_to(CLI::App& app);

private:
    void add_modes_to(CLI::App& app);
    void add_settings_to(CLI::App& app);
    void add_sweeps_to(CLI::App& app);
};

struct BenchJob {
    BenchKind kind = BenchKind::Contenders;
    SweepOver sweep = SweepOver::Rays;
    PicturesBy pictures = PicturesBy::Samples;
    uint64_t most = UINT64_MAX;         // max x of a sweep, or samples
    std::vector<std::string> workloads; // empty: primary, shadow, diffuse, frame
    bool float_rays = false;            // rays in numbers that floats have
    std::vector<std::string> scenes;
    bool scene_alone = false; // of the bars, only those about the scene
    ImageSize size;
    uint32_t repeats = 5;
    std::vector<Contender> contenders;
    uint64_t host_bytes = 0;       // for all contenders of a scene together; 0: no limit
    std::vector<Contender> beyond; // were asked for, but cannot keep to host_bytes
    std::string device;
    ovc_ranks_own ranks_own = OVC_RANKS_OWN_AUTO;
    std::string json; // a file, "-" for standard output, or empty
};

/// Returns the job, with defaults filled in. Error: a sentence about anything that can be found
/// wrong before a scene is read.
Result<BenchJob> understand_bench(const BenchWords& words);

/// Returns the items of a list such as "a,b,c". Error: an empty item; the sentence names `option`.
Result<std::vector<std::string>> parse_list(std::string_view option, std::string_view text);

/// Returns the choices of a list such as "8,32,auto". The item "auto" is the plugin's own choice,
/// and so is an empty text.
Result<std::vector<LeavesChoice>> parse_leaves_sweep(std::string_view text);

/// Returns the choices of a list of "shared" and "baked"; the plugin's own choice for an empty
/// text.
Result<std::vector<InstancesChoice>> parse_instances_sweep(std::string_view text);

/// Returns the choices of a list such as "all,12M,50%". Sizes are those of `overcast render`; "all"
/// is the device's default, and so is an empty text.
Result<std::vector<BudgetChoice>> parse_memory_sweep(std::string_view text);

/// Returns the choices of a list such as "all,30%", shares of the bytes of all pages.
Result<std::vector<BudgetChoice>> parse_resident_sweep(std::string_view text);

} // namespace ovc
