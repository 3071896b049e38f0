// SPDX-License-Identifier: Apache-2.0
// What a scene may ask about an object while it is read: the box around it, and where a ray meets
// it.
#pragma once

#include "core/box.h"
#include "importers/pov/object.h"

#include <limits>

namespace ovc::pov {

/// Where a ray meets a surface. distance: infinite where it does not. normal: of any length.
struct Meeting {
    double distance = std::numeric_limits<double>::infinity();
    dvec3 normal{0};
};

/// An object cut into triangles, placed in the space that it stands in.
struct CutObject {
    Facets facets; // its corners are finite
    std::vector<PlaneShape> planes;
};

/// As finely as a picture of it would be. Throws ParseError where that comes to more than
/// max_triangles. flatten.cpp has it.
CutObject cut_object(const Object& object, uint64_t max_triangles);

/// An object's triangles under a tree of boxes, and its planes.
class TraceTarget {
public:
    explicit TraceTarget(CutObject object);

    /// The first meeting. direction: of length 1, so that distances are lengths.
    Meeting first_meeting(const dvec3& origin, const dvec3& direction) const;

    size_t triangle_count() const { return object_.facets.corners.size() / 3; }

private:
    /// Triangles [first, last) of order_; inner: its children are the next node and `second`.
    struct Node {
        Box box;
        uint32_t first = 0, last = 0;
        uint32_t second = 0; // 0: a leaf
    };

    Box box_of(uint32_t triangle) const;
    void build(uint32_t first, uint32_t last);

    CutObject object_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace ovc::pov
