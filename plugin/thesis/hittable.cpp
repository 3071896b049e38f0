// SPDX-License-Identifier: Apache-2.0
// What is never hit is left out, and counted.
#include "plugin/thesis/hittable.h"

#include <fmt/format.h>

namespace ovc::thesis {

Hittable take_hittable(const Soup& soup, ovc_statistics& statistics, const LogSink& log,
                       BuildProgress* progress) {
    Hittable hittable;
    Dropped dropped;
    hittable.triangles = hittable_triangles(soup, &dropped, &hittable.bounds, progress);
    if (dropped.total())
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner, {} without area",
                        dropped.not_finite, dropped.degenerate));
    hittable.twins = Twins::take_out(soup, hittable.triangles, progress);
    statistics.triangles = soup.triangle_count();
    statistics.dropped_not_finite = dropped.not_finite;
    statistics.dropped_degenerate = dropped.degenerate;
    statistics.twins = hittable.twins.count();
    return hittable;
}

} // namespace ovc::thesis
