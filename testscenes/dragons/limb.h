// SPDX-License-Identifier: Apache-2.0
// A limb is a part of a creature: a tube around a curve, with a skin.
#pragma once

#include "testscenes/tube.h"

#include <vector>

namespace ovc::dragons {

/// A place of the curve, with half the width of the limb there, sideways and upwards.
struct Joint {
    dvec3 at;
    double across, up;
};

inline Joint operator+(const Joint& a, const Joint& b) {
    return {a.at + b.at, a.across + b.across, a.up + b.up};
}
inline Joint operator*(double s, const Joint& a) {
    return {s * a.at, s * a.across, s * a.up};
}

/// Returns how far the skin stands out. along: the share of the limb's length. turns: the way
/// around the limb, 0 at its right side, a quarter at its back. at: the place without skin.
using Skin = double (*)(double along, double turns, const dvec3& at);

struct Limb {
    std::vector<Joint> joints;
    /// The direction that is up at the first joint. It must not be along the curve.
    dvec3 back{0, 1, 0};
    Skin skin = nullptr;
};

/// A place of the limb's curve. Its axes turn with the curve and never about it.
struct Station {
    Joint joint;
    dvec3 ahead, side, back;
};

/// Returns `count` stations, evenly from the first joint to the last. count > 1.
std::vector<Station> stations(const Limb& limb, uint32_t count);

/// Measures how many triangles the limb needs, and how slender it is.
struct Extent {
    double area, length_per_girth;
};
Extent extent(const Limb& limb);

void add_limb(Surface& out, const Limb& limb, const TubeGrid& grid, bool with_normals);

} // namespace ovc::dragons
