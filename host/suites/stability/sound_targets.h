// SPDX-License-Identifier: Apache-2.0
// Finds the edges and vertices of a mesh with holes at which a ray must hit all the same, because
// triangles surround them without a gap.
#pragma once

#include "host/suites/stability/stability_rays.h"

#include <vector>

namespace ovc {

/// An edge is sound when exactly two triangles share it, in opposite directions; a vertex is sound
/// when all edges at it are. A ray aimed at a sound edge or vertex that sees the fronts of all
/// triangles there, or the backs of all, hits one of them, whatever holes there are elsewhere,
/// because their projections surround its target. Only the order of corners and the signs of
/// normals decide this, no ray/triangle test.
class SoundTargets {
public:
    /// Takes chunk 0 of the soup, which has one (asserted). Corners at the same place in double,
    /// origin included, are one vertex.
    explicit SoundTargets(const Soup& soup);

    /// Returns `count` rays, half at vertices and half at points of edges, half of them at fronts,
    /// from distances between a triangle's size and twice that of the mesh. There are fewer rays,
    /// or none, where the mesh has too few such targets.
    AimedRays rays(Random& random, size_t count) const;

    uint64_t sound_vertices() const { return vertices_.size(); }
    uint64_t vertices() const { return positions_.size(); }
    uint64_t sound_edges() const { return edges_.size(); }
    uint64_t edges() const { return edge_count_; }

private:
    struct Edge {
        uint32_t a, b;        // vertices
        uint32_t left, right; // triangles
    };

    void number_corners(const Soup& soup);
    void find_edges();
    void find_vertices();
    bool surrounds(std::span<const uint32_t> triangles, const Ray& ray) const;
    std::span<const uint32_t> triangles_at(uint32_t vertex) const;

    std::vector<dvec3> positions_;   // of vertices
    std::vector<uint32_t> corners_;  // 3 vertices for each triangle
    std::vector<uint32_t> first_at_; // each vertex' first index in at_, and the size of at_
    std::vector<uint32_t> at_;       // the triangles at each vertex
    std::vector<Edge> edges_;        // sound ones
    std::vector<uint32_t> vertices_; // sound ones
    uint64_t edge_count_ = 0;
    double size_ = 0; // of the mesh
};

} // namespace ovc
