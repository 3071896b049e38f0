// SPDX-License-Identifier: Apache-2.0
// The optics table's spawned rays: no ray hits the surface that it leaves, none leaves a closed
// shape unseen.
#pragma once

#include "host/report/optics/optics.h"

namespace ovc {

/// Rays aimed at options.shapes closed shapes of this size, reflected and refracted up to six
/// times. wrong: a ray from outside that meets its shape from inside, the reverse, and any that
/// meets the convex shape that it leaves.
Result<OpticsScore> spawned_rays(const OpticsOptions& options, const LogSink& log, double scale);

} // namespace ovc
