// SPDX-License-Identifier: Apache-2.0
// Polygons: a fan where that is right, else ear clipping in the plane.
// Based on: Meisters 1975, "Polygons have ears"; Newell's normal as in Tampieri 1992, Graphics Gems
// III, V.5.
#include "importers/polygon.h"

#include <numeric>

namespace ovc {

namespace {

dvec3 newell_normal(std::span<const dvec3> corners) {
    dvec3 normal(0);
    // Relative to the first corner, so that distance from the world's origin costs no precision.
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return normal;
}

double turn(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Drops the normal's major axis; the polygon turns left then.
std::vector<dvec2> flattened(std::span<const dvec3> corners, const dvec3& normal) {
    const int drop = major_axis(normal);
    int u = (drop + 1) % 3, v = (drop + 2) % 3;
    if (normal[drop] < 0)
        std::swap(u, v);
    std::vector<dvec2> flat;
    flat.reserve(corners.size());
    for (const dvec3& c : corners)
        flat.emplace_back(c[u] - corners[0][u], c[v] - corners[0][v]);
    return flat;
}

bool is_convex(const std::vector<dvec2>& flat) {
    const size_t n = flat.size();
    for (size_t i = 0; i < n; ++i)
        if (turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0)
            return false;
    return true;
}

class EarClipper {
public:
    explicit EarClipper(const std::vector<dvec2>& flat) : flat_(flat) {
        const auto n = uint32_t(flat.size());
        next_.resize(n);
        previous_.resize(n);
        for (uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
    }

    void run(std::vector<std::array<uint32_t, 3>>& triangles) {
        uint32_t left = uint32_t(flat_.size());
        uint32_t at = 0;
        uint32_t tried = 0;
        while (left > 3) {
            // No corner is an ear: the polygon crosses itself, and any cut is as good.
            if (tried < left && !is_ear(at)) {
                at = next_[at];
                ++tried;
                continue;
            }
            triangles.push_back({previous_[at], at, next_[at]});
            next_[previous_[at]] = next_[at];
            previous_[next_[at]] = previous_[at];
            // Going on behind the neighbour keeps triangles from becoming a fan of slivers.
            at = next_[next_[at]];
            --left;
            tried = 0;
        }
        triangles.push_back({previous_[at], at, next_[at]});
    }

private:
    bool is_ear(uint32_t i) const {
        const dvec2 &a = flat_[previous_[i]], &b = flat_[i], &c = flat_[next_[i]];
        if (turn(a, b, c) <= 0)
            return false;
        for (uint32_t k = next_[next_[i]]; k != previous_[i]; k = next_[k])
            if (blocks(k, a, b, c))
                return false;
        return true;
    }

    /// Corner k lies in the closed triangle. One that coincides with a corner of it, as at the ends
    /// of a bridge to a hole, does not count.
    bool blocks(uint32_t k, const dvec2& a, const dvec2& b, const dvec2& c) const {
        const dvec2& p = flat_[k];
        if (p == a || p == b || p == c)
            return false;
        return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    }

    const std::vector<dvec2>& flat_;
    std::vector<uint32_t> next_;
    std::vector<uint32_t> previous_;
};

} // namespace

void triangulate(std::span<const dvec3> corners, std::vector<std::array<uint32_t, 3>>& triangles) {
    if (corners.size() > 3) {
        const std::vector<dvec2> flat = flattened(corners, newell_normal(corners));
        if (corners.size() <= kMostConcaveCorners && !is_convex(flat))
            return EarClipper(flat).run(triangles);
    }
    for (uint32_t i = 1; i + 1 < corners.size(); ++i)
        triangles.push_back({0, i, i + 1});
}

} // namespace ovc
