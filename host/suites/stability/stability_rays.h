// SPDX-License-Identifier: Apache-2.0
// Makes the rays of the stability suite, aimed at targets that are hard to hit. Local origins, and
// directions, are floats, so that a program without doubles gets the same rays where the triangles
// are not moved.
#pragma once

#include "core/soup.h"
#include "testscenes/random.h"

#include <vector>

namespace ovc {

struct AimedRays {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip; // empty, or for each ray the triangle it does not see
};

enum class Side { Inside, Outside };
enum class Target { Vertices, Edges, Any };

/// The origins of rays at a closed mesh, and their targets.
struct Aim {
    Side side = Side::Inside;
    Target target = Target::Any;
    double grid = 0; // above 0: origins are multiples of it, so that rays meet vertices exactly
};

// Functions with a `count` return so many rays at the soup, whose chunk 0 has triangles.

/// Every ray passes a point inside the closed mesh in chunk 0, or begins there, so it must hit.
AimedRays closed_mesh_rays(const Soup& soup, Random& random, size_t count, const Aim& aim);
/// The same with targets of all kinds; half of the rays begin inside.
AimedRays any_closed_mesh_rays(const Soup& soup, Random& random, size_t count);

/// The same at vertices and edges; half of the rays begin inside. grid: as in Aim.
AimedRays edge_and_vertex_rays(const Soup& soup, Random& random, size_t count, double grid);

/// Returns a vertex, or a point of an edge or of the inside, rounded to float. Every other point of
/// an edge divides it at a multiple of an eighth.
dvec3 point_of(const Triangle& t, Random& random, Target target);

/// Rays go to vertices, edges and insides of any triangle, from near (its size) to far (the
/// soup's).
AimedRays rays_at_triangles(const Soup& soup, Random& random, size_t count);
/// Rays go down at the sheet in chunk 0, which they begin `height` above, to insides, edges and
/// vertices of its triangles.
AimedRays grazing_rays(const Soup& soup, Random& random, size_t count, double height);
/// Rays go across sliver_strip to vertices, edges and insides of all but its outer rows, so every
/// ray must hit.
AimedRays strip_rays(const Soup& soup, Random& random, size_t count);
/// Rays go down into the cone of fan, at its apex, spokes and faces.
AimedRays fan_rays(const Soup& soup, Random& random, size_t count);
/// Rays start inside box_of_squares at points of its grid and go along axes and diagonals of its
/// planes; zeros have both signs.
AimedRays axis_rays(const Soup& soup, Random& random, size_t count);
/// Rays lie in the planes of box_of_squares' own faces.
AimedRays in_plane_rays(const Soup& soup, Random& random, size_t count);

enum class Start { Surface, Vertex };
/// Rays start on the closed mesh in chunk 0. inwards: they go to a point inside, so they must hit;
/// otherwise anywhere. skip: they skip the triangle that they start on.
AimedRays surface_rays(const Soup& soup, Random& random, size_t count, Start start, bool skip,
                       bool inwards);

/// Rays have t_min or t_max just below, at or just above a hit.
AimedRays range_rays(const Soup& soup, Random& random, size_t count);
/// Returns any_closed_mesh_rays() with directions multiplied by powers of ten in [from, to].
AimedRays long_direction_rays(const Soup& soup, Random& random, size_t count, double from,
                              double to);
/// Rays have NaN or infinity in every field in turn, zero directions or empty ranges, so that none
/// is valid.
AimedRays bad_rays(const Soup& soup, Random& random, size_t count);

} // namespace ovc
