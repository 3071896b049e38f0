// SPDX-License-Identifier: Apache-2.0
// Leaves out triangles that can never be hit, and counts them.
#include "plugin/thesis/queued/hittable.h"

#include "core/text/format_text.h"

namespace ovc::thesis {

Hittable take_hittable(BuiltScene& scene, ovc_statistics& statistics, const LogSink& log,
                       BuildProgress* progress) {
    Hittable hittable = ovc::take_hittable(scene, progress);
    const Dropped& dropped = scene.dropped;
    if (dropped.total())
        say(log, LogLevel::Warning,
            format_text("left out {} triangles with a NaN or infinite corner, {} without area",
                        dropped.not_finite, dropped.degenerate));
    statistics.triangles = scene.soup.triangle_count();
    statistics.dropped_not_finite = dropped.not_finite;
    statistics.dropped_degenerate = dropped.degenerate;
    statistics.twins = scene.duplicates.count();
    return hittable;
}

} // namespace ovc::thesis
