// SPDX-License-Identifier: Apache-2.0
// Joins nested contours by bridges to one polygon, which importers/mesh/polygon.h triangulates.
#include "importers/pov/shapes/contour.h"

#include "importers/mesh/polygon.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

namespace ovc::pov {

namespace {

/// A contour as indices of points.
using Ring = std::vector<uint32_t>;

/// Joins `hole` (clockwise) to `ring` by a bridge from its rightmost point to the right.
/// Based on: Eberly, "Triangulation by Ear Clipping", section 4.
void join(Ring& ring, const Ring& hole, const std::vector<dvec2>& points) {
    assert(ring.size() >= 3 && hole.size() >= 3);
    const size_t start =
        size_t(std::max_element(hole.begin(), hole.end(),
                                [&](uint32_t a, uint32_t b) { return points[a].x < points[b].x; }) -
               hole.begin());
    const dvec2 m = points[hole[start]];
    double nearest = std::numeric_limits<double>::infinity();
    size_t bridge = 0;
    for (size_t i = 0; i < ring.size(); ++i) {
        const dvec2 a = points[ring[i]], b = points[ring[(i + 1) % ring.size()]];
        if ((a.y > m.y) == (b.y > m.y))
            continue;
        const double x = a.x + (b.x - a.x) * (m.y - a.y) / (b.y - a.y);
        if (x >= m.x && x < nearest) {
            nearest = x;
            bridge = a.x > b.x ? i : (i + 1) % ring.size();
        }
    }
    // Points of the ring within the triangle between m, the hit and p hide p from m. The one at the
    // smallest angle is visible, so the bridge goes there.
    const dvec2 p = points[ring[bridge]], hit(nearest, m.y);
    double best = std::numeric_limits<double>::infinity();
    const auto side = [](const dvec2& a, const dvec2& b, const dvec2& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    const size_t seen = bridge;
    for (size_t i = 0; i < ring.size(); ++i) {
        const dvec2 q = points[ring[i]];
        if (i == seen || q.x < m.x || q == p)
            continue;
        const double s1 = side(m, hit, q), s2 = side(hit, p, q), s3 = side(p, m, q);
        if ((s1 >= 0 && s2 >= 0 && s3 >= 0) || (s1 <= 0 && s2 <= 0 && s3 <= 0)) {
            const double slope = std::abs(q.y - m.y) / std::max(q.x - m.x, 1e-300);
            if (slope < best) {
                best = slope;
                bridge = i;
            }
        }
    }
    Ring joined(ring.begin(), ring.begin() + ptrdiff_t(bridge) + 1);
    for (size_t i = 0; i <= hole.size(); ++i)
        joined.push_back(hole[(start + i) % hole.size()]);
    joined.insert(joined.end(), ring.begin() + ptrdiff_t(bridge), ring.end());
    ring = std::move(joined);
}

} // namespace

bool is_inside(const dvec2& p, const Contour& c) {
    bool inside = false;
    for (size_t i = 0, j = c.size() - 1; i < c.size(); j = i++)
        if ((c[i].y > p.y) != (c[j].y > p.y) &&
            p.x < (c[j].x - c[i].x) * (p.y - c[i].y) / (c[j].y - c[i].y) + c[i].x)
            inside = !inside;
    return inside;
}

/// Returns a point that contours have in common with this one only where they share an edge: not
/// one of its corners, where they may touch.
static dvec2 middle_of_an_edge(const Contour& c) {
    return 0.5 * (c[0] + c[1]);
}

size_t depth_of(const Contour& contour, const std::vector<Contour>& contours) {
    return size_t(std::ranges::count_if(contours, [&](const Contour& other) {
        return &other != &contour && !other.empty() && is_inside(middle_of_an_edge(contour), other);
    }));
}

double doubled_area(const Contour& c) {
    double area = 0;
    for (size_t i = 0, j = c.size() - 1; i < c.size(); j = i++)
        area += c[j].x * c[i].y - c[i].x * c[j].y;
    return area;
}

std::vector<std::array<uint32_t, 3>> cut_contours(const std::vector<Contour>& contours) {
    const size_t count = contours.size();
    std::vector<dvec2> points;
    std::vector<Ring> rings(count);
    std::vector<size_t> depth(count, 0), order(count);
    for (size_t c = 0; c < count; ++c) {
        rings[c].resize(contours[c].size());
        std::iota(rings[c].begin(), rings[c].end(), uint32_t(points.size()));
        points.insert(points.end(), contours[c].begin(), contours[c].end());
        if (contours[c].size() >= 3)
            depth[c] = depth_of(contours[c], contours);
        const bool is_hole = depth[c] % 2 == 1;
        if (!contours[c].empty() && (doubled_area(contours[c]) < 0) != is_hole)
            std::reverse(rings[c].begin(), rings[c].end());
        order[c] = c;
    }
    // Holes are joined from right to left: each then sees the ring, or a hole already joined to it.
    const auto rightmost = [&](size_t c) {
        double x = -std::numeric_limits<double>::infinity();
        for (const dvec2& p : contours[c])
            x = std::max(x, p.x);
        return x;
    };
    std::sort(order.begin(), order.end(),
              [&](size_t a, size_t b) { return rightmost(a) > rightmost(b); });

    std::vector<std::array<uint32_t, 3>> triangles;
    for (size_t c = 0; c < count; ++c) {
        if (depth[c] % 2 == 1 || rings[c].size() < 3)
            continue;
        Ring ring = rings[c];
        for (const size_t hole : order)
            if (depth[hole] == depth[c] + 1 && rings[hole].size() >= 3 &&
                is_inside(middle_of_an_edge(contours[hole]), contours[c]))
                join(ring, rings[hole], points);
        std::vector<dvec3> outline;
        for (const uint32_t i : ring)
            outline.push_back(dvec3(points[i], 0));
        std::vector<std::array<uint32_t, 3>> cut;
        triangulate(outline, cut);
        for (const auto& t : cut)
            triangles.push_back({ring[t[0]], ring[t[1]], ring[t[2]]});
    }
    return triangles;
}

size_t points_of_a_piece(Curve curve) {
    switch (curve) {
    case Curve::Linear:
        return 2;
    case Curve::Quadratic:
        return 3;
    default:
        return 4;
    }
}

dvec2 curve_point(Curve curve, const dvec2* p, double t, dvec2* direction) {
    // d, c, b and a are the coefficients of 1, t, t^2 and t^3.
    dvec2 d = p[0], c = p[1] - p[0], b(0), a(0);
    if (curve == Curve::Quadratic) {
        d = p[1];
        c = 0.5 * (p[2] - p[0]);
        b = 0.5 * p[0] - p[1] + 0.5 * p[2];
    } else if (curve == Curve::Cubic) {
        d = p[1];
        c = 0.5 * (p[2] - p[0]);
        b = p[0] - 2.5 * p[1] + 2.0 * p[2] - 0.5 * p[3];
        a = 0.5 * (p[3] - p[0]) + 1.5 * (p[1] - p[2]);
    } else if (curve == Curve::Bezier) {
        c = 3.0 * (p[1] - p[0]);
        b = 3.0 * (p[0] - 2.0 * p[1] + p[2]);
        a = p[3] - p[0] + 3.0 * (p[1] - p[2]);
    }
    if (direction)
        *direction = c + t * (2.0 * b + t * 3.0 * a);
    return d + t * (c + t * (b + t * a));
}

} // namespace ovc::pov
