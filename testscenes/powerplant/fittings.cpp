// SPDX-License-Identifier: Apache-2.0
// Flanges, valves, pipes, rails.
#include "testscenes/noise.h"
#include "testscenes/powerplant/parts.h"

#include <algorithm>
#include <cmath>

namespace ovc::powerplant {

namespace {

/// Segments of something round: the larger, the more.
uint32_t segments_of(double radius) {
    return uint32_t(std::clamp(12 + 40 * radius, 12.0, 28.0)) / 2 * 2;
}

/// The two nuts of a bolt; what is between them is inside the flange.
void add_bolt(Corners& out, dvec3 at, dvec3 axis, double size) {
    const dvec2 nut[] = {{size, 0.7 * size}, {size, 1.5 * size}, {0, 1.5 * size}};
    add_turned(out, at, axis, nut, 6);
    add_turned(out, at, -axis, nut, 6);
}

void add_wheel(Works& works, dvec3 at, dvec3 axis, double radius) {
    const dvec3 side = any_perpendicular(axis), other = glm::cross(axis, side);
    std::vector<dvec3> rim;
    constexpr int kRim = 20, kSpokes = 5;
    for (int i = 0; i < kRim; ++i) {
        const dvec2 c = circle(double(i) / kRim);
        rim.push_back(at + radius * (c.x * side + c.y * other));
    }
    add_sweep(works[Paint::Fire], rim, 0.09 * radius, 8, true);
    for (int i = 0; i < kSpokes; ++i)
        add_rod(works[Paint::Fire], at, rim[size_t(i * kRim / kSpokes)], 0.05 * radius, 6);
}

} // namespace

void add_flange(Works& works, Paint paint, dvec3 at, dvec3 axis, double radius) {
    const double outer = radius + 0.045 + 0.25 * radius, half = 0.012 + 0.08 * radius;
    const dvec2 profile[] = {{radius, -2.4 * half}, {1.12 * radius, -half}, {outer, -0.9 * half},
                             {outer, -0.06 * half}, {0.97 * outer, 0},      {outer, 0.06 * half},
                             {outer, 0.9 * half},   {1.12 * radius, half},  {radius, 2.4 * half}};
    add_turned(works[paint], at, axis, profile, segments_of(radius));
    const dvec3 side = any_perpendicular(axis), other = glm::cross(axis, side);
    const auto bolts = uint32_t(8 + 4 * std::floor(radius / 0.12));
    for (uint32_t i = 0; i < bolts; ++i) {
        const dvec2 c = circle((i + 0.5) / bolts);
        const double out = 0.5 * (1.12 * radius + outer);
        add_bolt(works[Paint::Steel], at + out * (c.x * side + c.y * other), axis, 1.1 * half);
    }
}

void add_valve(Works& works, Paint paint, dvec3 at, dvec3 axis, dvec3 up, double radius) {
    const double r = radius;
    const dvec2 body[] = {{r, -2.2 * r}, {1.15 * r, -1.6 * r}, {1.5 * r, -0.9 * r},
                          {1.7 * r, 0},  {1.5 * r, 0.9 * r},   {1.15 * r, 1.6 * r},
                          {r, 2.2 * r}};
    add_turned(works[paint], at, axis, body, segments_of(radius));
    const dvec2 bonnet[] = {{0.9 * r, 0.8 * r},  {0.9 * r, 1.9 * r},  {1.35 * r, 1.95 * r},
                            {1.35 * r, 2.3 * r}, {0.6 * r, 2.4 * r},  {0.4 * r, 3.6 * r},
                            {0.55 * r, 3.7 * r}, {0.55 * r, 4.0 * r}, {0.15 * r, 4.05 * r},
                            {0.15 * r, 5.4 * r}, {0, 5.45 * r}};
    add_turned(works[paint], at, up, bonnet, segments_of(radius));
    add_wheel(works, at + 4.9 * r * up, up, 0.06 + 1.4 * r);
    add_flange(works, paint, at - 2.4 * r * axis, axis, r);
    add_flange(works, paint, at + 2.4 * r * axis, axis, r);
}

void add_pipe(Works& works, Paint paint, std::span<const dvec3> points, double radius, bool valve) {
    double bend = 3 * radius;
    for (size_t i = 0; i + 1 < points.size(); ++i)
        bend = std::min(bend, 0.45 * glm::length(points[i + 1] - points[i]));
    add_sweep(works[paint], bent_line(points, bend), radius, segments_of(radius));
    constexpr double kApart = 6;
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const double length = glm::length(points[i + 1] - points[i]);
        const dvec3 axis = (points[i + 1] - points[i]) / length;
        const double from = i > 0 ? 1.15 * bend : 0.3 * kApart;
        const double to = length - (i + 2 < points.size() ? 1.15 * bend : 0.3 * kApart);
        if (to <= from)
            continue;
        const auto steps = std::max(1u, uint32_t((to - from) / kApart));
        const dvec3 up = std::abs(axis.y) > 0.5 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
        for (uint32_t step = 0; step <= steps; ++step) {
            const dvec3 at = points[i] + (from + (to - from) * step / steps) * axis;
            const bool here = valve && 2 * step >= steps && to - from > 12 * radius;
            if (here)
                add_valve(works, paint, at - 3 * radius * axis, axis, up, radius);
            else
                add_flange(works, paint, at, axis, radius);
            valve = valve && !here;
        }
    }
}

void add_railing(Works& works, dvec3 from, dvec3 to) {
    const double length = glm::length(to - from);
    const auto posts = uint32_t(std::ceil(length / 1.2));
    Corners& out = works[Paint::Rail];
    for (uint32_t i = 0; i <= posts; ++i) {
        const dvec3 foot = from + (to - from) * (double(i) / posts);
        add_rod(out, foot, foot + dvec3(0, 1.05, 0), 0.022, 10);
        const dvec2 plate[] = {{0.06, 0}, {0.06, 0.012}, {0.03, 0.02}, {0.022, 0.06}};
        add_turned(out, foot, {0, 1, 0}, plate, 10);
    }
    for (const double height : {0.55, 1.07})
        add_rod(out, from + dvec3(0, height, 0), to + dvec3(0, height, 0), 0.024, 10);
    add_bar(out, from + dvec3(0, 0.08, 0), to + dvec3(0, 0.08, 0), 0.005, 0.06);
}

} // namespace ovc::powerplant
