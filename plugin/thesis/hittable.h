// SPDX-License-Identifier: Apache-2.0
// The triangles of a soup that a structure is built over, and the count of those left out.
#pragma once

#include "core/build_progress.h"
#include "core/log.h"
#include "core/soup.h"
#include "core/twins.h"
#include "plugin/overcast.h"

#include <vector>

namespace ovc::thesis {

struct Hittable {
    std::vector<TriangleId> triangles; // without twins
    Box bounds;
    Twins twins;
};

/// Counts what is left out in `statistics`, and warns of it.
Hittable take_hittable(const Soup& soup, ovc_statistics& statistics, const LogSink& log,
                       BuildProgress* progress = nullptr);

} // namespace ovc::thesis
