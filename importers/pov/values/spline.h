// SPDX-License-Identifier: Apache-2.0
// Reads spline { }, which interpolates points by a clock.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a spline from behind the word `spline`. It has at least one point.
Spline parse_spline(Reader& reader);

/// Takes the word of a kind of splines. Returns `otherwise` where none is next.
Spline::Kind take_spline_kind(Reader& reader, Spline::Kind otherwise);

/// Returns the point at `clock` of a spline of this kind through the spline's points. Before the
/// first point it is the first, behind the last the last.
Number at(const Spline& spline, Spline::Kind kind, double clock);

} // namespace ovc::pov
