// SPDX-License-Identifier: Apache-2.0
// survey_source() goes through all triangles of a source once: it counts them, finds the box around
// them and the checksums of their corners, and draws a sample.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"
#include "kdtree/far_search.h"
#include "plugin/leaf_store/corner_sums.h"
#include "plugin/out_of_core/local_soup.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>

namespace ovc {

struct SourceSurvey {
    uint64_t triangles = 0; // whether they can be hit or not
    Survey found;
    CornerSums sums;
    LocalSoup sample; // as sample_triangles() draws it of those that can be hit
    FarSearch far;    // among those that can be hit

    uint64_t hittable() const { return triangles - found.dropped.total(); }
};

/// rate: of the sample, a power of two. A triangle is a unit of progress.
SourceSurvey survey_source(TriangleSource& source, uint32_t rate, BuildProgress* progress);

} // namespace ovc
