// SPDX-License-Identifier: Apache-2.0
// Times whole programs in turn, each from its own file of the same mesh to a PNG: `overcast
// render`, and povray and tachyon where they are installed.
#pragma once

#include "core/scene.h"
#include "host/bench/ratios/paired_ratio.h"
#include "host/bench/workload.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// The picture that every program draws: one light with shadows and no antialiasing, with as many
/// threads as there are cores.
struct ProgramShot {
    dvec3 eye, target;
    double fov_degrees;
    dvec3 light;
    uint32_t size; // of the square picture, pixels a side
};

struct ProgramTimes {
    std::string name;
    std::string reads;           // "mesh2 text"
    std::vector<double> seconds; // wall clock of each run; empty: the program is not installed
    uint64_t bytes_read = 0;
};

struct ProgramsResult {
    std::string mesh;
    uint64_t triangles = 0;
    uint32_t size = 0;
    std::vector<ProgramTimes> programs; // overcast first
    bool complete = false;              // false: the race was stopped
};

/// Returns a camera in front of the bounds and a little above, with a light from their upper left.
/// Error: the bounds are empty.
Result<ProgramShot> shot_of(const Box& bounds, uint32_t size);

/// Return the scene in the language of POV-Ray and of Tachyon. POV-Ray's mesh2 shares vertices, as
/// a file of vertices and faces does; Tachyon's triangles cannot.
std::string povray_scene(const Soup& soup, const ProgramShot& shot);
std::string tachyon_scene(const Soup& soup, const ProgramShot& shot);

/// Runs each program once untimed, which fills the file cache, then `runs` times timed, in turn.
/// mesh: a file that `overcast render` takes. soup: its triangles. Pictures stay in `folder` as
/// overcast.png, povray.png, tachyon.png. Error: a program that fails, a full disk.
Result<ProgramsResult> race_programs(const std::string& mesh, const Soup& soup, uint32_t size,
                                     uint32_t runs, const std::filesystem::path& folder,
                                     const StopRequest& stop);

/// Returns the seconds of a program divided by those of overcast, run by run, or nothing where
/// either did not run. result.programs: overcast first (not empty: asserted).
std::optional<PairedRatio> times_as_fast(const ProgramsResult& result, std::string_view program);

std::string programs_table(const ProgramsResult& result);
std::string programs_json(const ProgramsResult& result);

} // namespace ovc
