// SPDX-License-Identifier: Apache-2.0
// The optics table's rows that have a formula: Snell's law in extended precision, facing mirrors.
#pragma once

#include "host/report/optics/optics.h"

namespace ovc {

/// Random directions through random planes, both ways, against the textbook's formula in long
/// double. wrong: farther off than roundings explain. error: largest, of a unit direction, where
/// the refracted ray is steeper than 1e-3.
OpticsScore snell(const OpticsOptions& options, double ior);

/// Light that leaves a medium 1e-15 to 1e-6 rad beside the critical angle. wrong: reflected or let
/// through unlike in long double, where a rounding of the direction does not decide; or no number.
OpticsScore critical_angle(const OpticsOptions& options, double ior);

/// Rays between two mirrors, 200 times to and fro. wrong: rays that do not count 200 bounces.
/// error: of the last point, relative to the way there.
Result<OpticsScore> facing_mirrors(const OpticsOptions& options, const LogSink& log);

} // namespace ovc
