// SPDX-License-Identifier: Apache-2.0
// Loop subdivision refines a triangle mesh level by level, then moves it to its limit surface.
// Based on: Loop 1987, "Smooth Subdivision Surfaces Based on Triangles"; Hoppe et al. 1994 for
// boundaries; the weights are pbrt's.
#include "importers/pbrt/shapes/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

namespace {

struct Edge {
    uint32_t a, b;     // a < b
    uint32_t opposite; // the vertex of the first face that lies off the edge
    uint32_t other;    // that of the last face
    uint32_t faces;
};

/// Holds every edge once, and for each corner the edge from it to the face's next one.
struct Edges {
    std::vector<Edge> edges;
    std::vector<uint32_t> of_corner;
};

Edges edges_of(const std::vector<uint32_t>& indices) {
    assert(indices.size() % 3 == 0);
    struct Side {
        uint64_t key;
        uint32_t corner;
        bool operator<(const Side& s) const {
            return key != s.key ? key < s.key : corner < s.corner;
        }
    };
    std::vector<Side> sides(indices.size());
    const auto next = [](uint32_t c) { return c % 3 == 2 ? c - 2 : c + 1; };
    for (uint32_t c = 0; c < indices.size(); ++c) {
        const uint64_t a = indices[c], b = indices[next(c)];
        sides[c] = {std::min(a, b) << 32 | std::max(a, b), c};
    }
    std::sort(sides.begin(), sides.end());
    Edges found;
    found.of_corner.resize(indices.size());
    for (size_t i = 0; i < sides.size(); ++i) {
        const uint32_t opposite = indices[next(next(sides[i].corner))];
        if (i == 0 || sides[i].key != sides[i - 1].key)
            found.edges.push_back(
                {uint32_t(sides[i].key >> 32), uint32_t(sides[i].key), opposite, opposite, 0});
        else
            found.edges.back().other = opposite;
        ++found.edges.back().faces;
        found.of_corner[sides[i].corner] = uint32_t(found.edges.size() - 1);
    }
    return found;
}

/// The neighbours of a vertex.
struct Ring {
    uint32_t valence = 0;
    uint32_t border_edges = 0; // edges with one face, or more than two
    dvec3 sum{0};
    dvec3 border_sum{0};
};

struct Level {
    std::vector<dvec3> vertices;
    std::vector<uint32_t> indices;
};

std::vector<Ring> rings_of(const Level& level, const Edges& edges) {
    std::vector<Ring> rings(level.vertices.size());
    for (const Edge& e : edges.edges)
        for (const auto& [v, other] : {std::pair(e.a, e.b), std::pair(e.b, e.a)}) {
            ++rings[v].valence;
            rings[v].sum += level.vertices[other];
            if (e.faces != 2) {
                ++rings[v].border_edges;
                rings[v].border_sum += level.vertices[other];
            }
        }
    return rings;
}

double beta(uint32_t valence) {
    assert(valence > 0);
    return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence);
}

/// Weighs a vertex against its ring, or against its two neighbours on the border that runs through
/// it. A vertex without edges, or with any other number of border edges, stays.
dvec3 weighed(const dvec3& vertex, const Ring& ring, double weight, double border_weight) {
    if (ring.border_edges == 2)
        return (1 - 2 * border_weight) * vertex + border_weight * ring.border_sum;
    if (ring.border_edges > 0 || ring.valence == 0)
        return vertex;
    return (1 - ring.valence * weight) * vertex + weight * ring.sum;
}

dvec3 middle_of(const Level& level, const Edge& e) {
    const dvec3 ends = level.vertices[e.a] + level.vertices[e.b];
    if (e.faces != 2)
        return 0.5 * ends;
    return 0.375 * ends + 0.125 * (level.vertices[e.opposite] + level.vertices[e.other]);
}

Level subdivided(const Level& level) {
    const Edges edges = edges_of(level.indices);
    const std::vector<Ring> rings = rings_of(level, edges);
    Level next;
    next.vertices.reserve(level.vertices.size() + edges.edges.size());
    for (size_t v = 0; v < level.vertices.size(); ++v) {
        const uint32_t n = rings[v].valence;
        next.vertices.push_back(
            weighed(level.vertices[v], rings[v], n == 6 ? 1.0 / 16 : beta(std::max(n, 1u)), 0.125));
    }
    for (const Edge& e : edges.edges)
        next.vertices.push_back(middle_of(level, e));
    const auto first = uint32_t(level.vertices.size());
    next.indices.reserve(level.indices.size() * 4);
    for (size_t f = 0; f < level.indices.size(); f += 3) {
        const uint32_t* v = &level.indices[f];
        const uint32_t ab = first + edges.of_corner[f], bc = first + edges.of_corner[f + 1],
                       ca = first + edges.of_corner[f + 2];
        for (const uint32_t i : {v[0], ab, ca, ab, v[1], bc, ca, bc, v[2], ab, bc, ca})
            next.indices.push_back(i);
    }
    return next;
}

void move_to_limit(Level& level) {
    const std::vector<Ring> rings = rings_of(level, edges_of(level.indices));
    for (size_t v = 0; v < level.vertices.size(); ++v) {
        const uint32_t n = std::max(rings[v].valence, 1u);
        level.vertices[v] = weighed(level.vertices[v], rings[v], 1 / (n + 3 / (8 * beta(n))), 0.2);
    }
}

/// Returns for each vertex the mean normal of the triangles around it, weighed by their areas.
std::vector<vec3> smooth_normals(const Level& level) {
    std::vector<dvec3> sums(level.vertices.size(), dvec3(0));
    for (size_t f = 0; f < level.indices.size(); f += 3) {
        const uint32_t* v = &level.indices[f];
        const dvec3 a = level.vertices[v[0]];
        const dvec3 n = glm::cross(level.vertices[v[1]] - a, level.vertices[v[2]] - a);
        for (int i = 0; i < 3; ++i)
            sums[v[i]] += n;
    }
    std::vector<vec3> normals;
    normals.reserve(sums.size());
    for (const dvec3& sum : sums) {
        const double length = glm::length(sum);
        normals.push_back(length > 0 && std::isfinite(length) ? vec3(sum / length) : vec3(0));
    }
    return normals;
}

} // namespace

std::optional<Mesh> make_loop_subdivision(ShapeRequest& request) {
    const Parameters& p = request.parameters;
    const double levels = p.number("levels", p.number("nlevels", 3));
    const std::vector<double> points = take_points(request);
    if (points.empty())
        return std::nullopt;
    auto indices = take_indices(request, points.size() / 3, 3);
    if (!indices || indices->empty())
        return indices ? left_out(request, "it has no indices") : std::nullopt;
    if (!(levels >= 0) || levels > 32)
        return left_out(request, fmt::format("found {} levels, expected 0 to 32", levels));
    const double triangles = double(indices->size()) / 3 * std::pow(4, std::floor(levels));
    if (triangles > double(request.max_triangles) || triangles * 3 > 4294967295.0) {
        request.diagnostics.fail(
            request.place,
            fmt::format("found a loopsubdiv of {:.0f} triangles, expected at most {} "
                        "more; --max-triangles allows more",
                        triangles, request.max_triangles));
        return std::nullopt;
    }

    Level level;
    for (size_t i = 0; i < points.size(); i += 3)
        level.vertices.emplace_back(points[i], points[i + 1], points[i + 2]);
    level.indices = std::move(*indices);
    for (int i = 0; i < int(levels); ++i)
        level = subdivided(level);
    move_to_limit(level);
    Mesh mesh;
    mesh.normals = smooth_normals(level);
    mesh.positions.reserve(level.vertices.size() * 3);
    for (const dvec3& v : level.vertices)
        mesh.add_vertex(v);
    mesh.indices = std::move(level.indices);
    return mesh;
}

} // namespace ovc::pbrt
