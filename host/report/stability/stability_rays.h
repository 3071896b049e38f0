// SPDX-License-Identifier: Apache-2.0
// The rays of the stability suite: aimed at what is hard to hit. Local origins, and directions, are
// floats, so that a program without doubles is asked the same where the triangles are not moved.
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

/// Where rays at a closed mesh begin and what they are aimed at.
struct Aim {
    Side side = Side::Inside;
    Target target = Target::Any;
    double grid = 0; // 0, or origins are multiples of this: then rays meet vertices exactly
};

/// Chunk 0 is a closed mesh: every ray passes a point inside it, or begins there, so it must hit.
AimedRays closed_mesh_rays(const Soup& soup, Random& random, size_t count, const Aim& aim);
/// Half begin inside; targets of all kinds.
AimedRays any_closed_mesh_rays(const Soup& soup, Random& random, size_t count);

/// At vertices and edges, half begin inside. grid: as in Aim.
AimedRays edge_and_vertex_rays(const Soup& soup, Random& random, size_t count, double grid);

/// A vertex, or a point of an edge or the inside, rounded to float; on edges every other one is a
/// multiple of an eighth.
dvec3 point_of(const Triangle& t, Random& random, Target target);

/// At vertices, edges and insides of any triangle, from near (its size) to far (the soup's).
AimedRays rays_at_triangles(const Soup& soup, Random& random, size_t count);
/// Down at the sheet of [-1, 1]^2 at height 0, `height` above it at their beginning, to insides,
/// edges and vertices of its triangles.
AimedRays grazing_rays(const Soup& soup, Random& random, size_t count, double height);
/// Across sliver_strip, aimed at vertices and edges within it: every ray must hit.
AimedRays strip_rays(const Soup& soup, Random& random, size_t count);
/// Down into the cone of fan, at its apex, spokes and faces.
AimedRays fan_rays(const Soup& soup, Random& random, size_t count);
/// Inside box_of_squares from points of its grid, along axes and diagonals of its planes; zeros of
/// both signs.
AimedRays axis_rays(const Soup& soup, Random& random, size_t count);
/// In the planes of box_of_squares' own faces.
AimedRays in_plane_rays(const Soup& soup, Random& random, size_t count);

enum class Start { Surface, Vertex };
/// From the closed chunk 0 itself. inwards: towards a point inside, so they must hit; else
/// anywhere.
AimedRays surface_rays(const Soup& soup, Random& random, size_t count, Start start, bool skip,
                       bool inwards);

/// t_min or t_max just below, at or just above a hit.
AimedRays range_rays(const Soup& soup, Random& random, size_t count);
/// closed_mesh_rays with directions `shrink` times as long, drawn from [from, to] powers of ten.
AimedRays long_direction_rays(const Soup& soup, Random& random, size_t count, double from,
                              double to);
/// Every field in turn NaN or infinite, zero directions, empty ranges: no ray is valid.
AimedRays bad_rays(const Soup& soup, Random& random, size_t count);

} // namespace ovc
