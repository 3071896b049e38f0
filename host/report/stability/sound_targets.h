// SPDX-License-Identifier: Apache-2.0
// Edges and vertices of a mesh with holes at which a ray must hit all the same: those that
// triangles surround without a gap.
#pragma once

#include "host/report/stability/stability_rays.h"

#include <vector>

namespace ovc {

/// An edge is sound when exactly two triangles share it, in opposite directions; a vertex when all
/// edges at it are. A ray at it that sees the fronts of all triangles there, or the backs of all,
/// hits one of them, whatever holes there are elsewhere: their projections surround its target.
/// Nothing but the order of corners and the signs of normals goes into this, no ray/triangle test.
class SoundTargets {
public:
    /// Of chunk 0, corners being one vertex where they are the same in double, at their place.
    explicit SoundTargets(const Soup& soup);

    /// Half at vertices, half at points of edges; half at fronts, from as near as a triangle's size
    /// to as far as the mesh is large. Fewer, or none, where the mesh has no such targets.
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
    std::vector<uint32_t> corners_;  // 3 a triangle: vertices
    std::vector<uint32_t> first_at_; // of a vertex, in at_; one more than vertices
    std::vector<uint32_t> at_;       // triangles
    std::vector<Edge> edges_;        // sound ones
    std::vector<uint32_t> vertices_; // sound ones
    uint64_t edge_count_ = 0;
    double size_ = 0; // of the mesh
};

} // namespace ovc
