// SPDX-License-Identifier: Apache-2.0
// The optics table's spawned rays check that no ray hits the surface that it leaves, and that none
// leaves a closed shape unseen.
#pragma once

#include "host/suites/optics/optics.h"

namespace ovc {

/// Follows rays that are aimed at options.shapes closed shapes of this size, through up to six
/// reflections and refractions. wrong: a ray from outside that meets its shape from inside, the
/// reverse, and any that leaves a convex shape and meets it again.
Result<OpticsScore> spawned_rays(const OpticsOptions& options, const LogSink& log, double scale);

} // namespace ovc
