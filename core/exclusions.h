// SPDX-License-Identifier: Apache-2.0
// Exclusions: the triangles that a ray meets but is not answered with.
#pragma once

#include "core/ray.h"
#include "core/sieve.h"

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace ovc {

/// A place in the order of the hits of a ray: by t, and where t is equal by triangle.
struct HitPlace {
    double t = -std::numeric_limits<double>::infinity(); // before all hits; so is NaN
    TriangleId id;
    /// It is known to be the place where the ray hits the triangle, so nobody need test that.
    bool is_certain = false;

    HitPlace() = default;
    explicit HitPlace(const Hit& hit) : t(hit.t), id(hit.id) {}
    Hit as_hit() const { return {t, 0, 0, id}; }

    bool is_before_all() const { return !(t > -std::numeric_limits<double>::infinity()); }
};

/// As a place: before all hits.
inline constexpr Hit kBeforeAll{.t = -std::numeric_limits<double>::infinity()};

/// The exclusions of one ray.
struct Exclusion {
    TriangleId skip; // the triangle that the ray starts on; none by default
    /// Only hits behind this place count. It stands for the exact place where the ray hits the
    /// triangle that it names, if the t of that hit rounds to this t; else for this t itself.
    HitPlace after;

    Exclusion(TriangleId skip_ = {}, HitPlace after_ = {}) : skip(skip_), after(after_) {}
};

/// The exclusions of the rays of a call. Each of the arrays is empty or has one element per ray.
struct Exclusions {
    std::span<const TriangleId> skip;
    std::span<const Hit> after; // of which u and v do not matter
    Sieves sieves;

    Exclusions() = default;
    Exclusions(std::span<const TriangleId> skip_, std::span<const Hit> after_ = {})
        : skip(skip_), after(after_) {}
    Exclusions(const std::vector<TriangleId>& skip_) : skip(skip_) {}

    /// Whether no ray has an Exclusion; sieves may still drop hits.
    bool empty() const { return skip.empty() && after.empty(); }
    bool are_for(size_t rays) const {
        return (skip.empty() || skip.size() == rays) && (after.empty() || after.size() == rays);
    }
    Exclusion operator[](size_t i) const {
        return {skip.empty() ? TriangleId() : skip[i],
                after.empty() ? HitPlace() : HitPlace(after[i])};
    }
    Exclusions subspan(size_t first, size_t count) const {
        Exclusions part(skip.empty() ? skip : skip.subspan(first, count),
                        after.empty() ? after : after.subspan(first, count));
        part.sieves = sieves.subspan(first, count);
        return part;
    }
};

} // namespace ovc
