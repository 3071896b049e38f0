// SPDX-License-Identifier: Apache-2.0
// The table of the stability suite: what is hard on arithmetic, by name. A new case is one row.
#pragma once

#include "core/result.h"
#include "host/report/stability/stability_rays.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

struct StabilityCase {
    std::string name;
    /// Every ray must hit: one that does not is a leak.
    bool closed;
    /// Rays of the short form, which the test runs.
    size_t rays;
    std::function<Soup()> soup;
    /// The same soup, random state and count give the same rays.
    std::function<AimedRays(const Soup&, Random&, size_t)> aim;
    /// The case whose time per ray this one must stay within so many times of; empty: none.
    std::string time_as;
    double within = 2.5;
};

/// Rays that meet thousands of triangles in one point, or are asked where doubles do not reach:
/// what one of them costs, next to what a ray costs that is decided exactly.
std::vector<StabilityCase> cliff_cases();

/// In the order of the report. data: the folder with meshes/stanford-dragon, or empty. Error: there
/// is no dragon in it.
Result<std::vector<StabilityCase>> stability_cases(const std::string& data);

} // namespace ovc
