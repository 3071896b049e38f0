// SPDX-License-Identifier: Apache-2.0
// The parts of the generated dragon.
#pragma once

#include "testscenes/dragons/limb.h"

namespace ovc::dragons {

/// The head lies in this plane of z, and is the same on both sides of it.
inline constexpr double kHeadPlane = 0.02;

// head.cpp: jaws, teeth, eyes, horns, ears, whiskers
void add_head(std::vector<Limb>& out);

// body.cpp
/// Returns the height of streaks and roughness, for hair and plates.
double strand_skin(double along, double turns, const dvec3& at);
/// Returns all parts, the body first.
std::vector<Limb> anatomy();

} // namespace ovc::dragons
