// SPDX-License-Identifier: Apache-2.0
// Motion between the transforms of ActiveTransform StartTime and EndTime.
#pragma once

#include "core/vec.h"

namespace ovc::pbrt {

/// Returns the transform at `time`, from 0 (start) to 1 (end). Both are taken apart into a shift, a
/// rotation and a stretch, and each of these goes on evenly, the rotation the short way. Where one
/// of them flattens space or projects it, the numbers of the matrices go on evenly instead.
///
/// Source: Pharr, Jakob and Humphreys, Physically Based Rendering, 3rd edition, section 2.9.3;
/// Shoemake and Duff, Matrix Animation and Polar Decomposition, 1992.
dmat4 between(const dmat4& start, const dmat4& end, double time);

} // namespace ovc::pbrt
