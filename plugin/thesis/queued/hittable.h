// SPDX-License-Identifier: Apache-2.0
// The triangles of a soup that a structure is built over, and the count of those left out.
#pragma once

#include "core/system/log.h"
#include "plugin/build/built_scene.h"
#include "plugin/overcast.h"

namespace ovc::thesis {

/// The triangles of the scene; counts in `statistics` what is left out, and warns of it.
Hittable take_hittable(BuiltScene& scene, ovc_statistics& statistics, const LogSink& log,
                       BuildProgress* progress = nullptr);

} // namespace ovc::thesis
