// SPDX-License-Identifier: Apache-2.0
// Scales a strip of slivers and its rays by powers of two, and moves them.
#include "host/suites/stability/stability_grid.h"

#include "host/suites/stability/stability_meshes.h"

#include <fmt/format.h>

#include <cmath>

namespace ovc {

namespace {

constexpr size_t kRaysOfAPoint = 2000;

Soup strip(const GridPoint& point, dvec3 place, double scale) {
    Soup soup;
    soup.chunks.push_back(placed(sliver_strip(std::pow(10, point.aspect_power)), place, scale));
    return soup;
}

/// Returns the rays of the unscaled strip, scaled and moved like the strip.
AimedRays moved_rays(const GridPoint& point, dvec3 place, double scale, Random& random,
                     size_t count) {
    AimedRays set = strip_rays(strip(point, dvec3(0), 1), random, count);
    for (Ray& ray : set.rays) {
        ray.org = place + scale * ray.org;
        ray.dir *= scale;
    }
    return set;
}

} // namespace

std::string GridPoint::name() const {
    return fmt::format("strip: aspect 1e{}, scale 2^{}, offset {}", aspect_power, scale_power,
                       offset_power < 0 ? "0" : fmt::format("1e{}", offset_power));
}

std::vector<GridPoint> stability_grid(bool quick) {
    const std::vector<int> scales =
        quick ? std::vector{-40, 0, 40} : std::vector{-60, -40, -20, 0, 20, 40, 60};
    std::vector<GridPoint> grid;
    for (const int aspect : {0, 3, 6})
        for (const int scale : scales)
            for (const int offset : {-1, 2, 4, 6})
                grid.push_back({aspect, scale, offset});
    return grid;
}

std::vector<StabilityCase> stability_grid_cases(bool quick) {
    std::vector<StabilityCase> cases;
    for (const GridPoint& point : stability_grid(quick)) {
        const double scale = std::ldexp(1.0, point.scale_power);
        const double away = point.offset_power < 0 ? 0 : std::pow(10, point.offset_power);
        const dvec3 place = scale * away * dvec3(1, -1, 1);
        cases.push_back({point.name(), /* closed= */ true, kRaysOfAPoint,
                         [=] { return strip(point, place, scale); },
                         [=](const Soup&, Random& random, size_t count) {
                             return moved_rays(point, place, scale, random, count);
                         },
                         ""});
    }
    return cases;
}

} // namespace ovc
