// SPDX-License-Identifier: Apache-2.0
// Computes the box around an object for min_extent() and max_extent().
#pragma once

#include "core/box.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// Returns the box around the object's triangles, in its parent's space. An endless object gets
/// POV-Ray's box of 1e10 to each side, one without triangles the origin. Throws ParseError where
/// the object has more parts than max_triangles allows.
Box bounds_of(const Object& object, uint64_t max_triangles);

/// Returns a box around the transformed `box`. Corners that are not finite do not count, so the
/// result is empty for a box that is empty or reaches to infinity on opposite sides.
Box moved(const Box& box, const dmat4& by);

} // namespace ovc::pov
