// SPDX-License-Identifier: Apache-2.0
// The box around an object: min_extent() and max_extent().
#pragma once

#include "core/box.h"
#include "importers/pov/object.h"

namespace ovc::pov {

/// Of its triangles, in the space that it stands in; empty: the box is all of space, as POV-Ray has
/// it for what is endless. Throws ParseError where it has more parts than so many triangles allow.
Box bounds_of(const Object& object, uint64_t max_triangles);

/// Around a box that a transformation has turned; nothing where it is empty or reaches to infinity.
Box moved(const Box& box, const dmat4& by);

} // namespace ovc::pov
