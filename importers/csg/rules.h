// SPDX-License-Identifier: Apache-2.0
// Which parts of an operand's surface bound the result: POV-Ray's rules. A part of an operand is
// judged beside its siblings, then its parent beside that one's, up to the root.
// Source: POV-Ray 3.7, All_CSG_Intersect_Intersections and All_CSG_Merge_Intersections in csg.cpp.
#pragma once

#include "importers/csg/csg.h"
#include "importers/csg/mesh.h"

#include <functional>

namespace ovc::csg {

class Rules {
public:
    explicit Rules(const Tree& tree);

    /// Operands that part the surface of this one into what stays and what goes. Found when asked
    /// for: where a thousand are taken away, each has a thousand.
    std::vector<uint32_t> cutters(uint32_t operand) const;
    bool has_cutters(uint32_t operand) const { return is_cut_[operand]; }
    /// Whether any of its surface can be seen.
    bool is_shown(uint32_t operand) const { return shown_[operand]; }

    /// sides(other): what is inside that operand above and below the part. below_is_inside: of the
    /// part's own operand.
    bool stays(uint32_t operand, bool below_is_inside,
               const std::function<Sides(uint32_t)>& sides) const;

private:
    Sides inside(uint32_t node, const std::function<Sides(uint32_t)>& sides) const;
    void gather(uint32_t node, std::vector<uint32_t>& operands) const;

    const Tree& tree_;
    std::vector<uint32_t> parent_;  // of each node; the root's is itself
    std::vector<uint32_t> node_of_; // of each operand
    std::vector<uint8_t> shown_, is_cut_;
};

} // namespace ovc::csg
