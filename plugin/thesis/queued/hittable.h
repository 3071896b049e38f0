// SPDX-License-Identifier: Apache-2.0
// Finds the triangles of a soup that a structure is built over, and counts those left out.
#pragma once

#include "core/system/log.h"
#include "plugin/build/built_scene.h"
#include "plugin/overcast.h"

namespace ovc::thesis {

/// Returns the triangles to build over; counts in `statistics` those left out, and warns of them.
Hittable take_hittable(BuiltScene& scene, ovc_statistics& statistics, const LogSink& log,
                       BuildProgress* progress = nullptr);

} // namespace ovc::thesis
