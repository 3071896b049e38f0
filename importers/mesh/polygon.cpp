// SPDX-License-Identifier: Apache-2.0
// A polygon becomes a fan where that is right; else its ears are clipped in the plane.
// Based on: Meisters 1975, "Polygons have ears"; Newell's normal as in Tampieri 1992, Graphics Gems
// III, V.5.
#include "importers/mesh/polygon.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace ovc {

namespace {

dvec3 newell_normal(std::span<const dvec3> corners) {
    dvec3 normal(0);
    // Edges start at the first corner, so that distance from the world's origin costs no precision.
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        normal += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return normal;
}

double turn(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Drops the normal's major axis, so that the polygon turns left.
std::vector<dvec2> flattened(std::span<const dvec3> corners, const dvec3& normal) {
    assert(!corners.empty());
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

/// Sorts corners into the cells of a grid, about two per cell, so that an ear is tested against
/// corners near it only. The grid has no cells if the corners are few, one is not finite, or all
/// have the same u or the same v.
class CornerGrid {
public:
    explicit CornerGrid(const std::vector<dvec2>& flat) : low_(flat[0]) {
        if (flat.size() < kFewCorners)
            return;
        dvec2 high = flat[0];
        for (const dvec2& p : flat) {
            low_ = glm::min(low_, p);
            high = glm::max(high, p);
        }
        const double side = std::floor(std::sqrt(double(flat.size()) / 2));
        scale_ = dvec2(side) / (high - low_);
        dvec2 sum(0);
        for (const dvec2& p : flat)
            sum += (p - low_) * scale_;
        if (!std::isfinite(sum.x + sum.y))
            return;
        side_ = int(side);
        corners_.resize(size_t(side_) * size_t(side_));
        for (uint32_t i = 0; i < flat.size(); ++i)
            corners_[cell(at(flat[i].x, 0), at(flat[i].y, 1))].push_back(i);
    }

    bool has_cells() const { return side_ > 0; }

    void remove(const dvec2& p, uint32_t corner) {
        std::vector<uint32_t>& list = corners_[cell(at(p.x, 0), at(p.y, 1))];
        const auto found = std::find(list.begin(), list.end(), corner);
        assert(found != list.end());
        *found = list.back();
        list.pop_back();
    }

    /// Returns whether visit() is true for a corner in the cells that the box touches; `work`
    /// counts cells and corners.
    template <class Visit>
    bool any(const dvec2& low, const dvec2& high, uint64_t& work, const Visit& visit) const {
        const int x_end = at(high.x, 0), y_end = at(high.y, 1);
        for (int y = at(low.y, 1); y <= y_end; ++y)
            for (int x = at(low.x, 0); x <= x_end; ++x) {
                const std::vector<uint32_t>& list = corners_[cell(x, y)];
                work += 1 + list.size();
                if (std::any_of(list.begin(), list.end(), visit))
                    return true;
            }
        return false;
    }

private:
    static constexpr size_t kFewCorners = 32;

    int at(double x, int axis) const {
        return std::min(int((x - low_[axis]) * scale_[axis]), side_ - 1);
    }
    size_t cell(int x, int y) const {
        assert(x >= 0 && x < side_ && y >= 0 && y < side_);
        return size_t(y) * size_t(side_) + size_t(x);
    }

    dvec2 low_;
    dvec2 scale_{0}; // cells per unit
    int side_ = 0;
    std::vector<std::vector<uint32_t>> corners_;
};

class EarClipper {
public:
    explicit EarClipper(const std::vector<dvec2>& flat)
        : flat_(flat),
          grid_(flat),
          max_work_(std::max<uint64_t>(kFreeWork, kWorkPerCorner * flat.size())) {
        assert(flat.size() > 3);
        const auto n = uint32_t(flat.size());
        next_.resize(n);
        previous_.resize(n);
        known_.resize(n);
        remembers_ = n > kForgetful;
        for (uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
    }

    void run(std::vector<std::array<uint32_t, 3>>& triangles) {
        uint32_t left = uint32_t(flat_.size());
        uint32_t at = 0;
        uint32_t tried = 0;
        bool skipped = false; // one of the corners tried was known to be no ear
        while (left > 3) {
            if (tried == left && std::exchange(skipped, false)) {
                // If corners coincide, a skipped one may have become an ear since.
                std::fill(known_.begin(), known_.end(), char(false));
                tried = 0;
                continue;
            }
            // If no corner is an ear, the polygon crosses itself, and any cut is as good.
            if (tried < left && work_ < max_work_ && (known_[at] || !is_ear(at))) {
                skipped = skipped || known_[at];
                known_[at] = remembers_;
                at = next_[at];
                ++tried;
                continue;
            }
            triangles.push_back({previous_[at], at, next_[at]});
            next_[previous_[at]] = next_[at];
            previous_[next_[at]] = previous_[at];
            known_[previous_[at]] = known_[next_[at]] = false;
            if (grid_.has_cells())
                grid_.remove(flat_[at], at);
            // Going on behind the neighbour keeps triangles from becoming a fan of slivers.
            at = next_[next_[at]];
            --left;
            tried = 0;
            skipped = false;
        }
        triangles.push_back({previous_[at], at, next_[at]});
    }

private:
    bool is_ear(uint32_t i) {
        const dvec2 &a = flat_[previous_[i]], &b = flat_[i], &c = flat_[next_[i]];
        ++work_;
        if (turn(a, b, c) <= 0)
            return false;
        if (grid_.has_cells())
            return !grid_.any(glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c), work_,
                              [&](uint32_t k) { return blocks(k, a, b, c); });
        for (uint32_t k = next_[next_[i]]; k != previous_[i]; k = next_[k])
            if (++work_; blocks(k, a, b, c))
                return false;
        return true;
    }

    /// Returns whether corner k lies in the closed triangle. A corner that coincides with one of
    /// the triangle's, as at the ends of a bridge to a hole, does not count.
    bool blocks(uint32_t k, const dvec2& a, const dvec2& b, const dvec2& c) const {
        const dvec2& p = flat_[k];
        if (p == a || p == b || p == c)
            return false;
        return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    }

    /// Beyond this much work any cut is as good. Polygons of 4095 corners that do not cross
    /// themselves were seen to need 10 to 410 a corner (a comb, spirals, stars, arcs).
    static constexpr uint64_t kWorkPerCorner = 512;
    /// Small polygons may use this much, crossing or not; 256 corners were seen to need 440
    /// thousand.
    static constexpr uint64_t kFreeWork = 1 << 19;
    /// Polygons of at most this many corners remember nothing: after a cut, each corner is tried
    /// again.
    static constexpr uint32_t kForgetful = 256;

    const std::vector<dvec2>& flat_;
    CornerGrid grid_;
    std::vector<uint32_t> next_;
    std::vector<uint32_t> previous_;
    std::vector<char> known_; // a corner known to be no ear, until a neighbour is cut
    bool remembers_ = false;
    uint64_t work_ = 0; // corners and cells looked at
    uint64_t max_work_;
};

} // namespace

void triangulate(std::span<const dvec3> corners, std::vector<std::array<uint32_t, 3>>& triangles) {
    if (corners.size() > 3) {
        const std::vector<dvec2> flat = flattened(corners, newell_normal(corners));
        if (corners.size() <= kMaxConcaveCorners && !is_convex(flat))
            return EarClipper(flat).run(triangles);
    }
    for (uint32_t i = 1; i + 1 < corners.size(); ++i)
        triangles.push_back({0, i, i + 1});
}

} // namespace ovc
