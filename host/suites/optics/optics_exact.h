// SPDX-License-Identifier: Apache-2.0
// The optics table's rows that have a formula: Snell's law in extended precision, facing mirrors.
#pragma once

#include "host/suites/optics/optics.h"

namespace ovc {

/// Refracts random directions at random planes, both ways, and compares them with the textbook's
/// formula in long double. wrong: farther off than roundings explain. error: largest, of a unit
/// direction, where the refracted ray is steeper than 1e-3.
OpticsScore snell(const OpticsOptions& options, double ior);

/// Refracts light that leaves a medium 1e-15 to 1e-6 rad beside the critical angle. wrong: it is
/// reflected where long double lets it through or the reverse, unless a rounding of the direction
/// decides, or a direction is not finite.
OpticsScore critical_angle(const OpticsOptions& options, double ior);

/// Follows rays between two mirrors for 200 bounces. wrong: rays that do not count 200 bounces.
/// error: of the last point, relative to the length of the way there.
Result<OpticsScore> facing_mirrors(const OpticsOptions& options, const LogSink& log);

} // namespace ovc
