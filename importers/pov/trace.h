// SPDX-License-Identifier: Apache-2.0
// Answers trace(), with which a scene asks, while it is read, where a ray meets an object.
#pragma once

#include "core/region/region.h"
#include "importers/pov/object.h"

#include <limits>

namespace ovc::pov {

/// The point where a ray meets a surface.
struct Meeting {
    double distance = std::numeric_limits<double>::infinity(); // infinite: the ray misses
    dvec3 normal{0};                                           // of any length
};

/// An object in its parent's space, as triangles where it has no formulas.
struct CutObject {
    Facets facets;        // with finite corners
    int32_t inverted = 0; // how many closed surfaces of them have their inside outside
    std::vector<HalfSpace> planes;
    std::vector<PlacedRound> exact;
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

    /// The region within the object.
    const Region& region() const { return region_; }
    size_t triangle_count() const { return normals_.size() / 3; }

private:
    Region region_;
    std::vector<dvec3> normals_; // of the corners of region_.triangles
};

} // namespace ovc::pov
