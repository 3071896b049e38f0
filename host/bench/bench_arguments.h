// SPDX-License-Identifier: Apache-2.0
// What `overcast bench` is asked to do, from its words.
#pragma once

#include "host/arguments/arguments.h"
#include "host/bench/contender.h"

#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// What is measured: contenders over scenes, the table of bars, whole programs, how cost grows, or
/// what pictures cost and how wrong they are.
enum class BenchKind { Contenders, Bars, Programs, Sweep, Pictures };
enum class SweepOver { Rays, Triangles, Leaves, Budget };
enum class PicturesBy { Samples, Tolerance };

/// The words as given.
struct BenchWords {
    std::vector<std::string> scenes;
    bool bars = false;
    bool programs = false;
    std::string sweep;
    std::string pictures;
    std::string most;
    std::string only;
    std::string workloads;
    std::string size; // empty: 1024x1024, of programs 512x512, of pictures 256x256
    std::string repeats = "5";
    std::string leaves;
    std::string gpu_memory;
    std::string resident;
    std::string device;
    std::string json;

    void add_to(CLI::App& app);

private:
    void add_modes_to(CLI::App& app);
    void add_settings_to(CLI::App& app);
};

struct BenchJob {
    BenchKind kind = BenchKind::Contenders;
    SweepOver sweep = SweepOver::Rays;
    PicturesBy pictures = PicturesBy::Samples;
    uint64_t most = UINT64_MAX;         // of rays, triangles or leaves of a sweep; of samples
    std::vector<std::string> workloads; // empty: all but edges
    std::vector<std::string> scenes;
    ImageSize size;
    uint32_t repeats = 5;
    std::vector<Contender> contenders;
    std::string device;
    std::string json; // a file, "-" for standard output, or empty
};

/// Everything that can be wrong before a scene is read.
Result<BenchJob> understand_bench(const BenchWords& words);

/// "a,b,c" without its commas. Error: an empty item. option: named in the error.
Result<std::vector<std::string>> parse_list(std::string_view option, std::string_view text);

/// "8,32,auto"; auto, and empty: the plugin's own choice.
Result<std::vector<LeavesChoice>> parse_leaves_sweep(std::string_view text);

/// "all,12M,50%": as `overcast render` takes them, and all for the device's default; empty: that
/// alone.
Result<std::vector<BudgetChoice>> parse_memory_sweep(std::string_view text);

/// "all,30%": shares of the bytes of all pages.
Result<std::vector<BudgetChoice>> parse_resident_sweep(std::string_view text);

} // namespace ovc
