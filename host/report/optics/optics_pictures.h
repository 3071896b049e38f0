// SPDX-License-Identifier: Apache-2.0
// The optics table's rows that render: glass that must not show, glass far away, deep mirrors.
#pragma once

#include "host/report/optics/optics.h"

namespace ovc {

/// A clear sphere of this index of refraction before a checked floor, against no sphere. wrong:
/// pixels that differ by more than 1e-6. error: the largest difference of a color.
Result<OpticsScore> unseen_glass(const OpticsOptions& options, const LogSink& log, double ior);

/// The picture of a glass and a mirror sphere at UTM coordinates, against that at the origin.
/// wrong: pixels that differ by more than 1e-4.
Result<OpticsScore> far_glass(const OpticsOptions& options, const LogSink& log);

} // namespace ovc
