// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.4.3.3, "Fog") says what fog is; that of the ground was found
// by asking povray for values, and so were rainbows (section 3.4.3.6).
#include "host/shade/surface/fog.h"

#include "core/smooth_step.h"
#include "core/texture/pattern.h"
#include "host/shade/finish.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

/// POV-Ray's way of a ray that hits nothing.
static constexpr double kEndless = 1e7;

static constexpr double kDegrees = 180 / std::numbers::pi; // in a radian

/// Returns the mean density, 1 / (1 + h^2) at heights h above 0 and 1 below, from `from` to `to`.
static double mean_density(double from, double to) {
    const double low = std::min(from, to), high = std::max(from, to);
    if (high <= 0)
        return 1;
    if (high - low < 1e-9)
        return 1 / (1 + low * low);
    return (low < 0 ? std::atan(high) - low : std::atan(high) - std::atan(low)) / (high - low);
}

/// Returns the number from 0 to 1 by which an arc that ends softly is there.
static double share_of_arc(const Rainbow& bow, const dvec3& direction) {
    if (bow.arc >= 360)
        return 1;
    // The angle around the bow's middle from the middle of its arc.
    const auto across = [&](const dvec3& v) {
        return v - glm::dot(v, bow.direction) * bow.direction;
    };
    const dvec3 here = across(direction), middle = across(bow.up);
    const double cosine = glm::dot(here, middle) / (glm::length(here) * glm::length(middle));
    const double off = 2 * kDegrees * std::acos(std::clamp(cosine, -1.0, 1.0));
    if (!(off < bow.arc))
        return 0;
    return off <= bow.full_arc ? 1 : smooth_step(bow.arc, bow.full_arc, off);
}

/// Returns the color at a share of the bow's width.
static TransparentColor color_of_bow(const Rainbow& bow, double share) {
    const Between at = between(
        bow.colors.size(), [&](size_t i) { return bow.colors[i].at; }, share, false);
    const TransparentColor &a = bow.colors[at.first].color, &b = bow.colors[at.second].color;
    const float t = float(at.share);
    return {glm::mix(a.rgb, b.rgb, t), glm::mix(a.filter, b.filter, t),
            glm::mix(a.transmit, b.transmit, t)};
}

ThroughFog through_rainbows(std::span<const Rainbow> bows, const Ray& ray, double t) {
    ThroughFog all;
    const double length = glm::length(ray.dir);
    const dvec3 direction = ray.dir / length;
    for (const Rainbow& bow : bows) {
        const double cosine = std::clamp(glm::dot(direction, bow.direction), -1.0, 1.0);
        double share = (kDegrees * std::acos(cosine) - bow.angle) / bow.width + 0.5;
        if (bow.jitter > 0)
            share += bow.jitter * (2 * double(random_share(direction)) - 1);
        if (!(share >= 0 && share <= 1))
            continue;
        const double arc = share_of_arc(bow, direction);
        const TransparentColor color = color_of_bow(bow, share);
        const double left = std::isfinite(t) ? std::exp(-t * length / bow.distance) : 0;
        const float hidden = float(arc * (1 - left)) * (1 - color.transmit);
        all.added += all.share * hidden * color.rgb;
        all.share *= 1 - hidden;
    }
    return all;
}

/// Returns the share of the fog that noise leaves on a way of this length, given in fog distances,
/// whose middle is `middle`.
static double share_of_noise(const Fog& fog, const dvec3& middle, double depth) {
    if (fog.turbulence == dvec3(0))
        return 1;
    const double noise =
        fog.turbulence_depth * scalar_turbulence(fog.turbulence * middle, fog.octaves, fog.noise);
    return 1 - std::clamp(noise, 0.0, 1.0) * std::exp(-depth);
}

ThroughFog through_fog(std::span<const Fog> fogs, const Ray& ray, double t) {
    ThroughFog all;
    const double length = glm::length(ray.dir);
    const double way = std::isfinite(t) ? t * length : kEndless;
    for (const Fog& fog : fogs) {
        const dvec3 end = ray.org + way / length * ray.dir;
        double depth = way / fog.distance;
        depth *= share_of_noise(fog, 0.5 * (ray.org + end), depth);
        if (fog.altitude > 0) {
            const auto height = [&](const dvec3& at) {
                return (glm::dot(at, fog.up) - fog.offset) / fog.altitude;
            };
            depth *= mean_density(height(ray.org), height(end));
        }
        const float left = std::max(float(std::exp(-depth)), fog.color.transmit);
        const vec3 tint = vec3(1 - fog.color.filter) + fog.color.filter * fog.color.rgb;
        all.added += (1 - left) * fog.color.rgb; // as povray has it, whatever lies before
        all.share *= left * tint;
    }
    return all;
}

} // namespace ovc
