// SPDX-License-Identifier: Apache-2.0
// The optics table's rows that render: glass that must not show, and glass and mirrors far away.
#pragma once

#include "host/suites/optics/optics.h"

namespace ovc {

/// Compares a picture of a checked floor behind a clear sphere of this index of refraction with one
/// without the sphere. wrong: pixels that differ by more than 1e-6. error: the largest difference
/// of a color.
Result<OpticsScore> unseen_glass(const OpticsOptions& options, const LogSink& log, double ior);

/// Compares the picture of a glass and a mirror sphere at UTM coordinates with that at the origin.
/// wrong: pixels that differ by more than 1e-4. error: as above.
Result<OpticsScore> far_glass(const OpticsOptions& options, const LogSink& log);

} // namespace ovc
