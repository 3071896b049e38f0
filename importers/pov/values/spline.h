// SPDX-License-Identifier: Apache-2.0
// spline { }: points by a clock.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Behind the word `spline`.
std::shared_ptr<const Spline> parse_spline(Reader& reader);

/// The point at `clock`; before the first and behind the last it stays there.
Number at(const Spline& spline, double clock);

} // namespace ovc::pov
