// SPDX-License-Identifier: Apache-2.0
// Answers trace(), with which a scene asks, while it is read, where a ray meets an object.
#pragma once

#include "core/box.h"
#include "importers/pov/object.h"

#include <limits>

namespace ovc::pov {

/// Where a ray meets a surface.
struct Meeting {
    double distance = std::numeric_limits<double>::infinity(); // infinite: the ray misses
    dvec3 normal{0};                                           // of any length
};

/// A shape that is known exactly, and how it is placed.
struct ExactPart {
    ExactShape shape;
    dmat4 to_shape{1}; // from the object's parent's space
};

/// An object in its parent's space, as triangles where it has no formulas.
struct CutObject {
    Facets facets; // with finite corners
    std::vector<PlaneShape> planes;
    std::vector<ExactPart> exact;
};

/// Returns the object cut as finely as for a picture of it alone. Throws ParseError where it would
/// have more than max_triangles triangles. flatten.cpp defines it.
CutObject cut_object(const Object& object, uint64_t max_triangles);

/// An object's triangles under a tree of boxes, its planes and its exact parts. Several threads may
/// trace it.
class TraceTarget {
public:
    explicit TraceTarget(CutObject object);

    /// Returns the meeting nearest to `origin`, in units of the direction's length, which should
    /// be 1. The ray does not meet surfaces within 1e-6 of its origin.
    Meeting first_meeting(const dvec3& origin, const dvec3& direction) const;

    /// Returns whether the point lies behind a plane or inside of closed surfaces, whose triangles
    /// run counterclockwise seen from outside.
    bool contains(const dvec3& point) const;

    size_t triangle_count() const { return object_.facets.corners.size() / 3; }

private:
    /// A node with the triangles [first, last) of order_. The children of an inner node are the
    /// next node and `second`.
    struct Node {
        Box box;
        uint32_t first = 0, last = 0;
        uint32_t second = 0; // 0 for a leaf
    };

    /// Calls use(corners) for the triangles of all leaves that the ray meets before `limit`, which
    /// `use` may lower.
    template <class Use>
    void for_each_near(const dvec3& origin, const dvec3& direction, const double& limit,
                       const Use& use) const;
    Box box_of(uint32_t triangle) const;
    void build(uint32_t first, uint32_t last);

    CutObject object_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace ovc::pov
