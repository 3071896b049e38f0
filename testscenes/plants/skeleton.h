// SPDX-License-Identifier: Apache-2.0
// The wood of a tree: branches that grow into the space of its crown.
// Based on: Runions, Lane and Prusinkiewicz 2007, "Modeling Trees with a Space Colonization
// Algorithm".
#pragma once

#include "testscenes/corners.h"
#include "testscenes/random.h"

#include <cstdint>
#include <vector>

namespace ovc::plants {

/// The space of a crown, round about the y axis between `bottom` and `top`. `widest` is the share
/// of its height at which it is widest.
struct Crown {
    double bottom = 2;
    double top = 8;
    double radius = 3;
    double widest = 0.45;
    double hollow = 0.5; // Nothing needs to grow in this inner share of the radius.
    uint32_t twigs = 500;
};

struct Knot {
    dvec3 at;
    dvec3 along;     // a unit vector from the parent
    uint32_t parent; // the root's parent is the root
    double radius = 0;
    bool is_tip = true;
};

/// Grows the branches. Parents come before children.
std::vector<Knot> grow(const Crown& crown, double tip_radius, Random& random);

/// Adds tapered tubes for all branches thicker than `thinnest`.
void add_wood(Corners& out, const std::vector<Knot>& knots, double thinnest, double detail);

} // namespace ovc::plants
