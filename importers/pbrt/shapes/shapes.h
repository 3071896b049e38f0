// SPDX-License-Identifier: Apache-2.0
// make_shape() makes each kind of the Shape directive into triangles.
#pragma once

#include "importers/importer.h"
#include "importers/pbrt/interpret/parameters.h"
#include "importers/pbrt/shapes/mesh.h"

namespace ovc::pbrt {

/// A Shape directive. Its parameters may be moved out of.
struct ShapeRequest {
    std::string_view type;
    Parameters& parameters;
    Place place;
    const Tokens& tokens; // where files are found
    Diagnostics& diagnostics;
    uint64_t max_triangles; // the number that the scene still allows
    double tolerance;       // kTolerance, or another
    bool wants_uv = false;  // the mesh gets its texture coordinates
    /// Where triangles of a large file may wait on a disk; null: they come in memory.
    const Streaming* streaming = nullptr;
};

/// Returns the shape's triangles. Returns nothing if the shape is unknown, lacks data, or has data
/// that does not fit together; the diagnostics then hold the reason.
std::optional<Mesh> make_shape(ShapeRequest& request);

/// The default of how far a triangle may lie off the curved surface that it stands for, in radii.
inline constexpr double kTolerance = 1.0 / 160;

// Each of these makes shapes as make_shape() does.
std::optional<Mesh> make_triangle_mesh(ShapeRequest& request);
std::optional<Mesh> make_ply_mesh(ShapeRequest& request);
std::optional<Mesh> make_height_field(ShapeRequest& request);
std::optional<Mesh> make_bilinear_mesh(ShapeRequest& request);
std::optional<Mesh> make_loop_subdivision(ShapeRequest& request);
std::optional<Mesh> make_quadric(ShapeRequest& request);

/// Returns the indices of a mesh as the file has them, all below `vertices` (at least 1) and in
/// groups of `group`. Returns nothing if they are unusable.
std::optional<std::vector<uint32_t>> take_indices(ShapeRequest& request, size_t vertices,
                                                  size_t group);
/// Returns the numbers of "P", three per point; warns and returns none if it is missing or does not
/// come in triples.
std::vector<double> take_points(ShapeRequest& request);
/// Returns the texture coordinates of the vertices, or none: where the request wants none, the file
/// has none, or, with a warning, where their number is wrong.
std::vector<vec2> take_uv(ShapeRequest& request, size_t vertices);
/// Returns the normals of the vertices, or none: where the file has none, or, with a warning, where
/// their number is wrong.
std::vector<vec3> take_normals(ShapeRequest& request, size_t vertices);
/// Warns that the shape is left out, and why.
std::nullopt_t left_out(ShapeRequest& request, std::string_view why);

} // namespace ovc::pbrt
