// SPDX-License-Identifier: Apache-2.0
// Measures how far triangles are from the round shapes that they approximate, and what finer
// tessellations cost.
#pragma once

#include "core/scene.h"
#include "host/bench/pictures/exact_shapes.h"
#include "host/bench/pictures/picture_race.h"
#include "host/bench/scene_bench.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// The distances of rays' answers from the exact shapes.
struct ShapeError {
    /// Distances of hit points from the nearest surface, in radii of its shape: the largest of each
    /// shape, and the root mean square of all.
    std::vector<double> largest_distance; // one for each shape; 0 where it is not hit
    double rms_distance = 0;
    /// Relative errors of t where both the triangles and the shapes are hit.
    double largest_t = 0;
    double rms_t = 0;
    uint64_t unlike = 0; // rays that hit the triangles and miss the shapes, or the other way
};

/// Returns the errors of `hits`. right: t where the rays hit the exact shapes (first_hits()). There
/// are as many hits and right values as rays (asserted).
ShapeError shape_error(std::span<const ExactShape> shapes, std::span<const Ray> rays,
                       std::span<const Hit> hits, std::span<const double> right);

struct TessellationRow {
    std::optional<double> tolerance; // empty: the reader's own choice
    uint64_t triangles = 0;
    uint64_t page_bytes = 0;
    std::vector<double> import_seconds, build_seconds, call_seconds; // one for each run
    ShapeError error;

    std::string name() const; // "tolerance 0.01"
};

struct TessellationJob {
    uint32_t size = 256; // of the square picture; there is one ray for each pixel
    uint32_t runs = 5;   // of each call and picture
    std::string device;
};

struct Tessellation {
    std::vector<std::string> shapes;
    uint32_t size = 0;
    uint64_t rays = 0;
    std::vector<TessellationRow> rows; // from coarse to fine, the reader's own last
    bool has_povray = false;
    /// One picture for each row, then povray's own of the exact shapes, which is the reference;
    /// empty without povray.
    PictureRace pictures;
    bool complete = false; // false: the run was stopped
};

/// Reads example_shapes() with the reader of .pov scenes at one tolerance after the other, and
/// traces camera rays with certified answers. Error: no device, a program that fails, a full disk.
Result<Tessellation> run_tessellation(const TessellationJob& job, const BenchSurroundings& around);

std::string tessellation_table(const Tessellation& result);
std::string tessellation_json(const Tessellation& result);

} // namespace ovc
