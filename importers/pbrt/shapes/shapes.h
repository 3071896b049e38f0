// SPDX-License-Identifier: Apache-2.0
// Shapes: the Shape directive's kinds, each made into triangles.
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
    uint64_t max_triangles; // what the scene still allows
    double tolerance;       // as kTolerance
};

/// Nothing where the shape is left out: unknown, without its data, or with data that does not fit
/// together. Why has been said, then.
std::optional<Mesh> make_shape(ShapeRequest& request);

/// How far a triangle may lie off the curved surface that it stands for, in radii, where nothing
/// else is asked for.
inline constexpr double kTolerance = 1.0 / 160;

// Each as make_shape().
std::optional<Mesh> make_triangle_mesh(ShapeRequest& request);
std::optional<Mesh> make_ply_mesh(ShapeRequest& request);
std::optional<Mesh> make_height_field(ShapeRequest& request);
std::optional<Mesh> make_bilinear_mesh(ShapeRequest& request);
std::optional<Mesh> make_loop_subdivision(ShapeRequest& request);
std::optional<Mesh> make_quadric(ShapeRequest& request);

/// The indices of a mesh as the file has them, checked against the number of vertices and to come
/// in groups. Nothing where they are unusable.
std::optional<std::vector<uint32_t>> take_indices(ShapeRequest& request, size_t vertices,
                                                  size_t group);
/// "P" in triples; empty where it is missing or not in triples, which has been said then.
std::vector<double> take_points(ShapeRequest& request);
/// Says why the shape is left out.
std::nullopt_t left_out(ShapeRequest& request, std::string_view why);

} // namespace ovc::pbrt
