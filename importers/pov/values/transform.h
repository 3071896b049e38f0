// SPDX-License-Identifier: Apache-2.0
// translate, rotate, scale, matrix, transform: matrices that take a point p to M p.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

dmat4 translation(const dvec3& by);
dmat4 scaling(const dvec3& by);
/// About x, then y, then z, in degrees.
dmat4 rotation(const dvec3& degrees);
dmat4 rotation_about(const dvec3& axis, double radians);

/// The transformation that comes next, its word included; nothing, and nothing taken, where none
/// does.
std::optional<dmat4> take_transform(Reader& reader);

/// What stands between `transform {` and its }, both still to come: `{ rotate 90*x inverse }`.
dmat4 parse_transform_block(Reader& reader);

} // namespace ovc::pov
