// SPDX-License-Identifier: Apache-2.0
// Cuts implicit surfaces, on which a field is 0, into triangles.
// Based on: Gibson 1998, "Constrained Elastic Surface Nets". Here vertices are moved onto the
// surface along the field's gradient.
#pragma once

#include "core/box.h"
#include "importers/csg/box_tree.h"
#include "importers/pov/shapes/facets.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace ovc::pov {

/// A function of space that is below 0 inside. Several threads call its functions at once.
struct Field {
    std::function<double(const dvec3&)> value;
    /// Returns a function that has the same values in this box only, but is cheaper. Where the
    /// field is nowhere 0 in the box, the same signs will do. May be empty.
    std::function<std::function<double(const dvec3&)>(const Box&)> within;
};

/// Finds those of a field's parts that are near a place. It keeps a reference to them.
template <class Part>
class PartsByPlace {
public:
    /// box_of(part): where the part counts.
    template <class BoxOf>
    PartsByPlace(const std::vector<Part>& parts, BoxOf&& box_of) : parts_(&parts) {
        std::vector<Box> boxes;
        for (const Part& part : parts)
            boxes.push_back(box_of(part));
        tree_ = csg::BoxTree(boxes);
    }

    /// Returns the parts whose boxes touch `box`, in order.
    std::vector<Part> near(const Box& box) const {
        std::vector<Part> found;
        for (const uint32_t i : tree_.touching(box))
            found.push_back((*parts_)[i]);
        return found;
    }

private:
    const std::vector<Part>* parts_;
    csg::BoxTree tree_;
};

/// Returns how many cells along its longest side make a closed shape as fine as a sphere of
/// `segments` segments.
inline int field_cells(int segments) {
    return segments * 2 / 3;
}

/// Adds the field's surface in the box, which has `cells` > 0 cells along its longest side, to
/// `out`. Corners lie on the surface and have its normals. Outside the box further triangles close
/// the surface. Returns the number of triangles up to these, which come last. Parts thinner than a
/// cell may be lost. An empty or infinite box adds nothing.
size_t cut_field(const Field& field, const Box& box, int cells, Facets& out);

} // namespace ovc::pov
