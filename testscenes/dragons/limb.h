// SPDX-License-Identifier: Apache-2.0
// Limb: a part of a creature: a tube round a curve, with a skin.
#pragma once

#include "testscenes/tube.h"

#include <vector>

namespace ovc::dragons {

/// A place of the curve, and half the width of the limb there, sideways and upwards.
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

/// How far the skin stands out at a share of the length and round the limb (0: its right side, a
/// quarter: its back), where `at` is the place without skin.
using Skin = double (*)(double along, double turns, const dvec3& at);

struct Limb {
    std::vector<Joint> joints;
    dvec3 back{0, 1, 0}; // which side is up at the first joint; not along the curve
    Skin skin = nullptr;
};

/// The curve of a limb, with axes that turn with it and never about it.
struct Station {
    Joint joint;
    dvec3 ahead, side, back;
};

/// `count` stations, evenly from the first joint to the last, count > 1.
std::vector<Station> stations(const Limb& limb, uint32_t count);

/// A measure of how many triangles the limb deserves, and of its slenderness.
struct Extent {
    double area, length_per_girth;
};
Extent extent(const Limb& limb);

void add_limb(Surface& out, const Limb& limb, const TubeGrid& grid, bool with_normals);

} // namespace ovc::dragons
