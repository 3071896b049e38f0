// SPDX-License-Identifier: Apache-2.0
// Reads spline { }, which interpolates points by a clock.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a spline from behind the word `spline`. It has at least one point.
Spline parse_spline(Reader& reader);

/// Returns the point at `clock`. Before the first point it is the first, behind the last the last.
Number at(const Spline& spline, double clock);

} // namespace ovc::pov
