// SPDX-License-Identifier: Apache-2.0
// Bars, turned bodies, sweeps.
#include "testscenes/noise.h"
#include "testscenes/powerplant/parts.h"

#include <algorithm>

namespace ovc::powerplant {

namespace {

/// Corner i of the box has bit a of i set where it lies at the far end of axis a.
template <class Corner>
void add_hexahedron(Corners& out, Corner&& corner) {
    constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& s : sides)
        add_quad(out, corner(s[0]), corner(s[1]), corner(s[2]), corner(s[3]));
}

using Ring = std::vector<dvec3>;

void join_rings(Corners& out, const Ring& a, const Ring& b) {
    for (size_t j = 0; j < a.size(); ++j) {
        const size_t next = (j + 1) % a.size();
        add_quad(out, a[j], a[next], b[next], b[j]);
    }
}

/// A fan over a ring, which runs against the clock as seen from outside.
void add_lid(Corners& out, const Ring& ring, bool reversed) {
    for (size_t j = 1; j + 1 < ring.size(); ++j)
        add_triangle(out, ring[0], ring[reversed ? j + 1 : j], ring[reversed ? j : j + 1]);
}

} // namespace

void add_box(Corners& out, dvec3 lo, dvec3 hi) {
    add_hexahedron(out, [&](int i) {
        return dvec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    });
}

void add_bar(Corners& out, dvec3 a, dvec3 b, double width, double height) {
    const dvec3 along = glm::normalize(b - a);
    const dvec3 side = std::abs(along.y) > 0.99 ? dvec3(1, 0, 0)
                                                : glm::normalize(glm::cross(along, dvec3(0, 1, 0)));
    const dvec3 up = glm::cross(side, along);
    add_hexahedron(out, [&](int i) {
        return (i & 1 ? b : a) + (i & 2 ? height : -height) * up + (i & 4 ? width : -width) * side;
    });
}

void add_turned(Corners& out, dvec3 base, dvec3 axis, std::span<const dvec2> profile,
                uint32_t segments) {
    const dvec3 side = any_perpendicular(axis), other = glm::cross(axis, side);
    Ring directions;
    for (uint32_t j = 0; j <= segments; ++j) {
        const dvec2 c = circle(double(j % segments) / segments);
        directions.push_back(c.x * side + c.y * other);
    }
    const auto point = [&](const dvec2& p, uint32_t j) {
        return base + p.y * axis + p.x * directions[j];
    };
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
        const dvec2 p = profile[i], q = profile[i + 1];
        for (uint32_t j = 0; j < segments; ++j) {
            if (p.x > 0)
                add_triangle(out, point(p, j), point(p, j + 1), point(q, j + 1));
            if (q.x > 0)
                add_triangle(out, point(p, j), point(q, j + 1), point(q, j));
        }
    }
}

void add_rod(Corners& out, dvec3 a, dvec3 b, double radius, uint32_t segments) {
    const dvec3 line[] = {a, b};
    add_sweep(out, line, radius, segments);
}

void add_sweep(Corners& out, std::span<const dvec3> line, double radius, uint32_t segments,
               bool round) {
    const size_t count = line.size();
    const auto ahead_at = [&](size_t i) {
        const size_t before = i > 0 ? i - 1 : round ? count - 1 : 0;
        const size_t after = i + 1 < count ? i + 1 : round ? 0 : i;
        return glm::normalize(line[after] - line[before]);
    };
    dvec3 side = any_perpendicular(ahead_at(0));
    const auto ring_at = [&](size_t i) {
        const dvec3 ahead = ahead_at(i);
        side = glm::normalize(side - glm::dot(side, ahead) * ahead);
        const dvec3 other = glm::cross(ahead, side);
        Ring ring(segments);
        for (uint32_t j = 0; j < segments; ++j) {
            const dvec2 c = circle(double(j) / segments);
            ring[j] = line[i] + radius * (c.x * side + c.y * other);
        }
        return ring;
    };
    const Ring first = ring_at(0);
    Ring before = first;
    for (size_t i = 1; i < count; ++i) {
        Ring ring = ring_at(i);
        join_rings(out, before, ring);
        before = std::move(ring);
    }
    if (round) {
        join_rings(out, before, first);
        return;
    }
    add_lid(out, first, true);
    add_lid(out, before, false);
}

std::vector<dvec3> bent_line(std::span<const dvec3> points, double radius) {
    constexpr int kSteps = 8;
    std::vector<dvec3> line = {points[0]};
    for (size_t i = 1; i + 1 < points.size(); ++i) {
        const dvec3 in = glm::normalize(points[i] - points[i - 1]);
        const dvec3 out = glm::normalize(points[i + 1] - points[i]);
        for (int step = 0; step <= kSteps; ++step) {
            // A right angle's arc; for other angles, a curve of the same ends.
            const dvec2 c = circle(0.25 * step / kSteps);
            line.push_back(points[i] - radius * (1 - c.y) * in + radius * (1 - c.x) * out);
        }
    }
    line.push_back(points.back());
    return line;
}

} // namespace ovc::powerplant
