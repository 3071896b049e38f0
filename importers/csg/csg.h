// SPDX-License-Identifier: Apache-2.0
// Constructive solid geometry on triangles: finds the parts of the operands' surfaces that bound
// the result. Every part is cut exactly and remembers its triangle. docs/design/solids.md explains
// how.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc::csg {

struct Operand {
    /// The corners run counterclockwise seen from outside.
    std::vector<std::array<dvec3, 3>> triangles;
    /// Says for each triangle whether it only bounds and is never part of a result. An empty vector
    /// hides none.
    std::vector<uint8_t> hidden;
    /// A solid's inside is where a ray crosses the triangles an odd number of times. An operand
    /// that is not solid has no inside, and neither has its complement, as in POV-Ray.
    bool solid = true;
    /// An inverse operand's inside is the outside of its triangles.
    bool inverse = false;
};

enum class Kind {
    Operand,
    Union,        // Joins the surfaces. Those inside other children stay.
    Merge,        // Joins the solids.
    Intersection, //
    Clip,         // Keeps the first child inside all others, whose surfaces are not shown.
};

struct Node {
    Kind kind = Kind::Operand;
    uint32_t operand = 0;           // the operand's number
    std::vector<uint32_t> children; // the numbers of nodes
};

struct Tree {
    std::vector<Operand> operands;
    std::vector<Node> nodes; // Children stand before their parents, and the root is last.
};

/// A triangle of the result, and the triangle of an operand that it is a part of.
struct Part {
    uint32_t operand;
    uint32_t triangle;
    bool turned; // The part's outside is the operand's inside. Its corners are in order already.
    std::array<dvec3, 3> corners;
};

/// Returns the surface of the result. If the operands are closed, so is the result: edges that
/// meet have the same corners, bit for bit. Corners are off by at most 2^-36 of the size of all
/// operands.
///
/// If surfaces coincide and face the same way, the first one is kept; if they face opposite ways,
/// both are dropped. A triangle with a corner that is not finite is dropped.
std::vector<Part> evaluate(const Tree& tree);

} // namespace ovc::csg
