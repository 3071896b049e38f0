// SPDX-License-Identifier: Apache-2.0
// Constructive solid geometry on triangles: which parts of the operands' surfaces bound the result.
// Every part is cut exactly and remembers the triangle that it is of. docs/design/solids.md says
// how.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc::csg {

struct Operand {
    /// Corners, counterclockwise seen from outside.
    std::vector<std::array<dvec3, 3>> triangles;
    /// For each triangle, whether it only bounds and is never part of a result; empty: none is.
    std::vector<uint8_t> hidden;
    /// Inside is where a ray crosses the triangles an odd number of times; or nowhere, and the
    /// complement is nowhere either, as POV-Ray has it for what has no inside.
    bool solid = true;
    /// Inside is everywhere else.
    bool inverse = false;
};

enum class Kind {
    Operand,
    Union,        // of the surfaces: those inside the others stay
    Merge,        // of the solids
    Intersection, //
    Clip,         // the first child where it is inside all others, whose surfaces are not shown
};

struct Node {
    Kind kind = Kind::Operand;
    uint32_t operand = 0;           // its number
    std::vector<uint32_t> children; // numbers of nodes
};

struct Tree {
    std::vector<Operand> operands;
    std::vector<Node> nodes; // the last is the root; children stand before parents
};

/// A part of the result: a triangle, and the one that it is a part of.
struct Part {
    uint32_t operand;
    uint32_t triangle;
    bool turned; // its outside is the operand's inside; corners are in order already
    std::array<dvec3, 3> corners;
};

/// The surface of the result. Where the operands are closed so are the parts together: edges that
/// meet have the same corners, bit for bit. Corners are off by at most 2^-36 of the size of all
/// operands. Of surfaces that coincide and look the same way the first one is kept; those that look
/// opposite ways are both dropped. A corner that is not finite makes its triangle drop out.
std::vector<Part> evaluate(const Tree& tree);

} // namespace ovc::csg
