// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.4.3.3, "Fog") says what fog is; that of the ground was found
// by asking povray for values.
#include "host/shade/surface/fog.h"

#include <algorithm>
#include <cmath>

namespace ovc {

/// POV-Ray's way of a ray that hits nothing.
static constexpr double kEndless = 1e7;

/// Returns the mean density, 1 / (1 + h^2) at heights h above 0 and 1 below, from `from` to `to`.
static double mean_density(double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    if (high <= 0)
        return 1;
    if (high - low < 1e-9)
        return 1 / (1 + low * low);
    return (low < 0 ? std::atan(high) - low : std::atan(high) - std::atan(low)) / (high - low);
}

ThroughFog through_fog(std::span<const Fog> fogs, const Ray& ray, double t) {
    ThroughFog all;
    const double length = glm::length(ray.dir);
    const double way = std::isfinite(t) ? t * length : kEndless;
    for (const Fog& fog : fogs) {
        double depth = way / fog.distance;
        if (fog.altitude > 0) {
            const auto height = [&](const dvec3& at) {
                return (glm::dot(at, fog.up) - fog.offset) / fog.altitude;
            };
            const dvec3 end = ray.org + way / length * ray.dir;
            depth *= mean_density(height(ray.org), height(end));
        }
        const float left = std::max(float(std::exp(-depth)), fog.color.transmit);
        const vec3 tint = vec3(1 - fog.color.filter) + fog.color.filter * fog.color.rgb;
        all.added += all.share * (1 - left) * fog.color.rgb;
        all.share *= left * tint;
    }
    return all;
}

} // namespace ovc
