// SPDX-License-Identifier: Apache-2.0
// Tessellation: how far triangles are from the round shapes they stand for, and what finer ones
// cost.
#pragma once

#include "core/scene.h"
#include "host/bench/pictures/exact_shapes.h"
#include "host/bench/pictures/picture_race.h"
#include "host/bench/scene_bench.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// How far the answers of rays are from the exact shapes.
struct ShapeError {
    /// Of hit points from the nearest surface, in radii of its shape: the largest of each shape,
    /// and the root mean square of all.
    std::vector<double> largest_distance; // as the shapes; 0 where none is hit
    double rms_distance = 0;
    /// Of t, relative, where both hit.
    double largest_t = 0;
    double rms_t = 0;
    uint64_t unlike = 0; // rays that hit the triangles and miss the shapes, or the other way
};

/// hits, and right, t where the exact shapes are hit (first_hits()): as many as rays.
ShapeError shape_error(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                       std::span<const Hit> hits, std::span<const double> right);

struct TessellationRow {
    std::optional<double> tolerance; // nothing: what the reader does by itself
    uint64_t triangles = 0;
    uint64_t page_bytes = 0;
    std::vector<double> import_seconds, build_seconds, call_seconds; // one a run; of all rays
    ShapeError error;

    std::string name() const; // "tolerance 0.01"
};

struct TessellationJob {
    uint32_t size = 256; // of the square picture, and with it rays
    uint32_t runs = 5;   // of each call and picture
    std::string device;
};

struct Tessellation {
    std::vector<std::string> shapes;
    uint32_t size = 0;
    uint64_t rays = 0;
    std::vector<TessellationRow> rows; // from coarse to fine, the reader's own last
    bool has_povray = false;
    /// A picture a row, then povray's own of the exact shapes, which is right; empty without it.
    PictureRace pictures;
    bool complete = false; // false: it was stopped
};

/// Spheres, cones and tori through the reader of .pov scenes at one tolerance after the other, and
/// camera rays through certified answers. Error: no device, a program that fails, a full disk.
Result<Tessellation> run_tessellation(const TessellationJob& job, const BenchSurroundings& around);

std::string tessellation_table(const Tessellation& result);
std::string tessellation_json(const Tessellation& result);

} // namespace ovc
