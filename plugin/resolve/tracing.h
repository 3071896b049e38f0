// SPDX-License-Identifier: Apache-2.0
// Tracing: the objects that waves, resolving and passes share.
#pragma once

#include "plugin/build/built_scene.h"
#include "plugin/overcast.h"
#include "plugin/plan/two_level_options.h"
#include "plugin/structure/call_watch.h"

namespace ovc {

/// The objects that it refers to outlive everything that keeps a Tracing.
struct Tracing {
    const BuiltScene& scene;
    const TwoLevelOptions& options;
    ovc_statistics& statistics; // tracing counts here; report() adds what the scene tells
    CallWatch& watch;
};

} // namespace ovc
