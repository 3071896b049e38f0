// SPDX-License-Identifier: Apache-2.0
// The table of the stability suite: cases that are hard on arithmetic, by name. A new case is one
// row.
#pragma once

#include "core/scene.h"
#include "host/suites/stability/stability_rays.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

struct StabilityCase {
    std::string name;
    /// Every ray must hit, and one that does not is a leak.
    bool closed;
    /// The number of rays in the short form, which the test runs.
    size_t rays;
    std::function<Soup()> soup;
    /// Returns the rays. The same soup, random state and count give the same rays.
    std::function<AimedRays(const Soup&, Random&, size_t)> aim;
    /// A ray may take `within` times as long as one of the case with this name; empty: no limit.
    std::string time_as;
    double within = 2.5;
    /// How many times as long the report wants it to take at most; 0: as long as it may.
    double bar = 0;
};

/// Returns cases of rays that meet thousands of triangles in one point, or that start beyond the
/// reach of doubles. Their time is compared with that of a ray that is decided exactly.
std::vector<StabilityCase> cliff_cases();

/// Returns all cases in the order of the report. dragon: the scan (load_dragon), which must outlive
/// the cases, or null for none.
std::vector<StabilityCase> stability_cases(const Scene* dragon);

} // namespace ovc
