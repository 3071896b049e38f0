// SPDX-License-Identifier: Apache-2.0
// Whole programs in turn, each from its own file of the same mesh to a PNG: `overcast render`, and
// povray and tachyon where they are installed.
#pragma once

#include "core/scene.h"
#include "host/bench/workload.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

/// One light with shadows, no antialiasing, as many threads as there are cores.
struct ProgramShot {
    dvec3 eye, target;
    double fov_degrees;
    dvec3 light;
    uint32_t size; // of the square picture, pixels a side
};

struct ProgramTimes {
    std::string name;
    std::string reads;           // "mesh2 text"
    std::vector<double> seconds; // of wall clock, one a run; empty: it is not installed
    uint64_t bytes_read = 0;
};

struct ProgramsResult {
    std::string mesh;
    uint64_t triangles = 0;
    uint32_t size = 0;
    std::vector<ProgramTimes> programs; // overcast first
    bool complete = false;              // false: it was stopped
};

/// From before the mesh's front and a little above, lit from its upper left.
ProgramShot shot_of(const Box& bounds, uint32_t size);

/// A text that POV-Ray and Tachyon read. Vertices of POV-Ray's mesh2 are shared as in a file of
/// vertices and faces; Tachyon's triangles have none to share.
std::string povray_scene(const Soup& soup, const ProgramShot& shot);
std::string tachyon_scene(const Soup& soup, const ProgramShot& shot);

/// mesh: a file that `overcast render` takes; soup: what is in it. Each program runs once untimed,
/// which fills the cache of files, then `runs` times, in turn. Pictures stay in `folder` as
/// overcast.png, povray.png, tachyon.png. Error: a program that fails, a full disk.
Result<ProgramsResult> race_programs(const std::string& mesh, const Soup& soup, uint32_t size,
                                     uint32_t runs, const std::filesystem::path& folder,
                                     const StopRequest& stop);

/// Median seconds of a program over those of overcast; nothing where it did not run.
std::optional<double> times_as_fast(const ProgramsResult& result, std::string_view program);

std::string programs_table(const ProgramsResult& result);
std::string programs_json(const ProgramsResult& result);

} // namespace ovc
