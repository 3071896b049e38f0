// SPDX-License-Identifier: Apache-2.0
// Forecast: what two-level would make of a soup, told by a sample of it before anything is built.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "core/soup.h"
#include "plugin/two_level_options.h"

#include <cstdint>

namespace ovc {

/// Counts are whole numbers, most of them estimated.
struct Forecast {
    uint64_t triangles = 0; // that can be hit
    uint64_t leaves = 0;
    uint64_t references = 0; // triangles counted once in each leaf they touch
    uint64_t level2_bytes = 0;
    uint64_t largest_page_bytes = 0;
    uint64_t smallest_budget_bytes = 0; // that works
    uint64_t resident_pages = 0;        // in the pool at once, in the order of leaves
    uint64_t level1_bytes = 0;          // of the budget
    uint64_t pool_bytes = 0;
    uint64_t host_bytes = 0; // level 1 and level 2 in host memory
    bool fits = true;        // the budget is not too small
};

/// Looks at every triangle twice and builds level 1 and pages over a sample; a soup of a few
/// thousand triangles is built and thrown away. Error: as of plan_memory(); too many triangles.
Result<Forecast> forecast(const Soup& soup, const TwoLevelOptions& options,
                          const DeviceInfo& device, BuildProgress* progress = nullptr);

} // namespace ovc
