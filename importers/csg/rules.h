// SPDX-License-Identifier: Apache-2.0
// Decides by POV-Ray's rules which parts of an operand's surface bound the result. A part of an
// operand is compared with the operand's siblings, then with its parent's siblings, up to the root.
// Source: POV-Ray 3.7, All_CSG_Intersect_Intersections and All_CSG_Merge_Intersections in csg.cpp.
#pragma once

#include "importers/csg/csg.h"
#include "importers/csg/mesh.h"

#include <functional>

namespace ovc::csg {

class Rules {
public:
    explicit Rules(const Tree& tree);

    /// Returns the operands that may remove a part of this one's surface. The list is not stored,
    /// because in a difference of a thousand operands each has a thousand.
    std::vector<uint32_t> cutters(uint32_t operand) const;
    bool has_cutters(uint32_t operand) const { return is_cut_[operand]; }
    /// Returns whether the result can show some of the operand's surface.
    bool is_shown(uint32_t operand) const { return shown_[operand]; }

    /// Returns whether a part of the operand's surface bounds the result.
    /// below_is_inside: the inside of the part's own operand is below the part.
    /// sides(other): returns whether the places above and below the part are inside that operand.
    bool stays(uint32_t operand, bool below_is_inside,
               const std::function<Sides(uint32_t)>& sides) const;

private:
    Sides inside(uint32_t node, const std::function<Sides(uint32_t)>& sides) const;
    void gather(uint32_t node, std::vector<uint32_t>& operands) const;

    const Tree& tree_;
    std::vector<uint32_t> parent_;  // the parent of each node; the root's parent is itself
    std::vector<uint32_t> node_of_; // the node of each operand
    std::vector<uint8_t> shown_, is_cut_;
};

} // namespace ovc::csg
