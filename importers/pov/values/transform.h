// SPDX-License-Identifier: Apache-2.0
// Reads translate, rotate, scale, matrix and transform as matrices M that take a point p to M p.
#pragma once

#include "importers/matrix.h"
#include "importers/pov/values/expression.h"

#include <array>

namespace ovc::pov {

/// Returns the rotation about x, then y, then z. It is exact for multiples of 90 degrees.
dmat4 rotation(const dvec3& degrees);
/// Returns the rotation about an axis of any length; about 0 it rotates nothing.
dmat4 rotation_about(const dvec3& axis, double radians);

/// Returns the rows of the matrix without its last, which is 0, 0, 0, 1.
std::array<dvec4, 3> rows_of(const dmat4& matrix);

/// Takes the transformation that comes next, its word included. Takes and returns nothing where
/// the next token is another word.
std::optional<dmat4> take_transform(Reader& reader);

/// Reads `{ rotate 90*x inverse }`, which stands behind the word transform.
dmat4 parse_transform_block(Reader& reader);

} // namespace ovc::pov
