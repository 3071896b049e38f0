// SPDX-License-Identifier: Apache-2.0
// The reference: tests rays against triangles as exact arithmetic decides, and against boxes.
// Certified mode returns its answers. Based on: Woop, Benthin and Wald 2013, "Watertight
// Ray/Triangle Intersection", section 3; Shewchuk 1997 (doubles first, exact sums where they leave
// a doubt); Ize 2013, "Robust BVH Ray Traversal", section 3. Needs -ffp-contract=off and rounding
// to nearest.
#pragma once

#include "core/box.h"
#include "core/exact/exact_solution.h"
#include "core/exclusions.h"
#include "core/ray.h"
#include "core/soup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace ovc {

/// A ray made ready for tests: the basis that maps it onto the z axis, and the margin that keeps
/// box tests conservative.
struct PreparedRay {
    Ray ray;
    int kx, ky, kz;       // kz: the major axis of dir
    double sx, sy, sz;    // shear and scale of Woop et al. 2013, section 3.1
    dvec3 inv_dir;        // may be infinite
    TriangleId skip;      // a triangle this ray does not see: the one it starts on
    HitPlace after;       // only hits behind this place count; t_min is not far before it
    double org_error = 0; // bounds how far, in each coordinate, the line is from the intended one

    explicit PreparedRay(const Ray& r, const Exclusion& without = {})
        : ray(behind(r, without.after)), skip(without.skip), after(without.after) {
        // No t beyond the largest double can be told.
        ray.t_max = std::min(r.t_max, std::numeric_limits<double>::max());
        kz = major_axis(r.dir);
        kx = (kz + 1) % 3;
        ky = (kz + 2) % 3;
        sx = r.dir[kx] / r.dir[kz];
        sy = r.dir[ky] / r.dir[kz];
        sz = 1.0 / r.dir[kz];
        inv_dir = dvec3(1.0) / r.dir;
    }

    /// Returns the part of the ray that holds all hits behind the place. A t that rounds to that of
    /// the place may be a little less.
    static Ray behind(Ray ray, const HitPlace& place) {
        if (!place.is_before_all())
            ray.t_min = std::max(ray.t_min,
                                 std::nextafter(place.t, -std::numeric_limits<double>::infinity()));
        return ray;
    }

    /// Returns more than the rounding error, in each coordinate, of positions along this ray within
    /// `bounds`.
    double margin(const Box& bounds) const {
        return 0x1p-46 * max_component(glm::max(glm::abs(bounds.lo - ray.org),
                                                glm::abs(bounds.hi - ray.org))) +
               org_error;
    }
};

/// Whether doubles can tell where the ray meets planes across the axes.
inline bool has_walked_direction(const PreparedRay& p) {
    const double longest = std::abs(p.ray.dir[p.kz]);
    for (int axis = 0; axis < 3; ++axis)
        if (p.ray.dir[axis] != 0 && !std::isfinite(p.inv_dir[axis]))
            return false;
    return longest >= kMinWalkedDirection && longest <= kMaxWalkedDirection;
}

/// A hit of one triangle.
struct Candidate {
    static constexpr uint32_t kAllCorners = 7;

    Hit hit;          // t, u and v approximately
    double t_low = 0; // t is within t_error of hit.t + t_low
    double t_error = 0;
    uint32_t support =
        kAllCorners;      // bit i: corner i has a part in the hit. One bit: the hit is that
                          // corner, two: it lies on that side. All where that is not known
    bool refined = false; // t is from doubled precision, which need not be asked again

    /// Returns a t that the hit's is certainly not above.
    double latest_t() const { return hit.t + (std::abs(t_low) + t_error); }

    /// Returns the sign of this t minus the other's, on the same ray; 0 where errors leave it open.
    int compare_t(const Candidate& other) const {
        const double low = t_low - other.t_low;
        const double gap = (hit.t - other.hit.t) + low;
        const double error = t_error + other.t_error + 0x1p-52 * std::abs(low);
        return gap > error ? 1 : gap < -error ? -1 : 0;
    }
};

/// Returns the answer of candidate() where doubles cannot tell it: in doubled precision
/// (core/exact/refined.h), and exactly where that leaves a doubt.
std::optional<Candidate> exact_candidate(const PreparedRay& p, const Triangle& triangle,
                                         TriangleId id);

/// Returns where the ray meets the closed triangle, t_min <= t <= t_max; nothing where it does not.
/// Exact arithmetic would decide the same: doubles with an error bound decide, and
/// exact_candidate() where they leave a doubt. So a ray never slips between two triangles that
/// share corners bit for bit. A triangle seen exactly edge-on is not hit. in_doubt(p, triangle, id)
/// is called instead of exact_candidate().
template <class InDoubt>
std::optional<Candidate> candidate(const PreparedRay& p, const Triangle& triangle, TriangleId id,
                                   InDoubt&& in_doubt) {
    if (id == p.skip)
        return std::nullopt;
    constexpr double u = 0x1p-53;
    double x[3], y[3], z[3], size[3], reach[3];
    for (int i = 0; i < 3; ++i) {
        const dvec3 d = triangle[i] - p.ray.org;
        x[i] = d[p.kx] - p.sx * d[p.kz];
        y[i] = d[p.ky] - p.sy * d[p.kz];
        z[i] = d[p.kz];
        size[i] = std::abs(x[i]) + std::abs(y[i]);
        reach[i] = size[i] + std::abs(z[i]);
    }
    // docs/design/numerics.md, "The reference": a projected corner is off by 6u reach, and an edge
    // function by what that and its own roundings add up to. Where products underflow it is off by
    // 2^-1074 times a coordinate more, at most 2^257.
    const auto edge_error = [&](int i, int j) {
        return 12 * u * (reach[i] * size[j] + reach[j] * size[i] + 12 * u * reach[i] * reach[j]) +
               0x1p-814;
    };
    const double a = x[2] * y[1] - y[2] * x[1];
    const double b = x[0] * y[2] - y[0] * x[2];
    const double c = x[1] * y[0] - y[1] * x[0];
    const double a_error = edge_error(2, 1);
    const double b_error = edge_error(0, 2);
    const double c_error = edge_error(1, 0);
    const bool any_positive = a > a_error || b > b_error || c > c_error;
    const bool any_negative = a < -a_error || b < -b_error || c < -c_error;
    if (any_positive && any_negative)
        return std::nullopt;
    const bool inside = std::abs(a) > a_error && std::abs(b) > b_error && std::abs(c) > c_error;
    if (!inside)
        return in_doubt(p, triangle, id);
    const double area = a + b + c;
    const double t = (a * z[0] + b * z[1] + c * z[2]) / area * p.sz;
    const double per_area = 1 / std::abs(area);
    const double share = std::min(2 * (a_error + b_error + c_error) * per_area, 1.0);
    const double z_min = std::min({z[0], z[1], z[2]});
    const double z_max = std::max({z[0], z[1], z[2]});
    const double underflow = 0x1p-1000 * (per_area + 1); // of products of z, and the quotient
    const double t_error = (share * (z_max - z_min) +
                            12 * u * std::max(std::abs(z_min), std::abs(z_max)) + underflow) *
                               std::abs(p.sz) +
                           0x1p-1020;
    const bool outside = t + t_error < p.ray.t_min || t - t_error > p.ray.t_max;
    if (outside && std::isfinite(t)) // else the t may be one of doubles all the same
        return std::nullopt;
    if (!(t - t_error >= p.ray.t_min && t + t_error <= p.ray.t_max))
        return in_doubt(p, triangle, id);
    return Candidate{{t, b / area, c / area, id}, 0, t_error};
}

inline std::optional<Candidate> candidate(const PreparedRay& p, const Triangle& triangle,
                                          TriangleId id) {
    return candidate(p, triangle, id, exact_candidate);
}

/// A hit that others of the same ray are compared with, and its triangle.
struct ComparedHit {
    Candidate found;
    Triangle triangle{};
    std::optional<ExactSolution> exactly; // where a comparison has asked for it

    ComparedHit() = default;
    ComparedHit(const Candidate& found_, const Triangle& triangle_)
        : found(found_), triangle(triangle_) {}

    /// Returns the sign of the other hit's place minus this one's in the order of t, mesh and prim,
    /// as exact arithmetic has it. May make both more precise.
    int order(const PreparedRay& p, Candidate& other, const Triangle& of_other) {
        const int by_t = other.compare_t(found);
        return by_t != 0 ? by_t : order_closely(p, other, of_other);
    }

private:
    int order_closely(const PreparedRay& p, Candidate& other, const Triangle& of_other);
};

/// Returns the hit that the place names: that of its triangle, if its t rounds to that of the
/// place; nothing where it does not.
std::optional<Candidate> hit_at(const Ray& ray, const Triangle& triangle, const HitPlace& place);

/// Tells which hits of a ray lie behind the place that it excludes up to.
class Behind {
public:
    /// p, which has such a place, outlives this. triangle: the one that the place names; nullptr
    /// where there is none.
    Behind(const PreparedRay& p, const Triangle* triangle);

    bool has(Candidate& found, const Triangle& triangle);

private:
    const PreparedRay& p_;
    std::optional<ComparedHit> place_; // where the place is a hit, and not only a t
};

/// Keeps the nearest of the triangles offered, as exact arithmetic would choose: smaller t wins,
/// equal t the smaller id. The ray must outlive it.
class Nearest {
public:
    /// triangle_after: the one that p.after names; nullptr where there is none.
    explicit Nearest(const PreparedRay& p, const Triangle* triangle_after = nullptr) : p_(p) {
        if (!p.after.is_before_all())
            behind_.emplace(p, triangle_after);
    }

    /// Tests the triangle. Returns true where it is hit, though perhaps not the nearest, or seen
    /// edge-on through the nearest hit; false where it is missed, not behind p.after, or has lost
    /// before.
    bool offer(const Triangle& triangle, TriangleId id) {
        if (id == best_.found.hit.id)
            return is_hit();
        if (best_.found.support != Candidate::kAllCorners && id != p_.skip &&
            offer_neighbour(triangle, id))
            return true;
        std::optional<Candidate> found =
            candidate(p_, triangle, id, [&](auto&&...) { return in_doubt(triangle, id); });
        return found && enter(*found, triangle);
    }
    /// Enters a hit that candidate() would find. Returns the same as offer().
    bool enter(Candidate found, const Triangle& triangle) {
        if (!counts(found, triangle))
            return false;
        if (!is_hit() || best_.order(p_, found, triangle) < 0)
            best_ = {found, triangle};
        return true;
    }

    bool is_hit() const { return best_.found.hit.is_hit(); }

    /// Returns the hit, its t, u and v rounded once: the doubles nearest to the exact values.
    Hit hit() const;
    /// Returns the hit as it was found, for callers that only ask whether something is hit.
    const Hit& unrounded_hit() const { return best_.found.hit; }
    /// Returns the hit with its triangle.
    const ComparedHit& best() const { return best_; }

    /// Returns the t beyond which nothing can win any more.
    double limit() const {
        return is_hit() ? std::min(best_.found.latest_t(), p_.ray.t_max) : p_.ray.t_max;
    }

private:
    /// The triangles decided of late, in a table in which they push each other out.
    class Recent {
    public:
        Recent() : ids_{} {} // Clang 14 takes it for not constructible within Nearest otherwise
        void add(TriangleId id) { ids_[slot(id)] = id; }
        bool has(TriangleId id) const { return ids_[slot(id)] == id; }

    private:
        static constexpr size_t kSlots = 512;
        static size_t slot(TriangleId id) { return (id.prim + 31 * size_t(id.mesh)) % kSlots; }

        std::array<TriangleId, kSlots> ids_;
    };

    /// Decides a triangle that shares the corner or side that the best hit lies on, as thousands
    /// may, without another exact number. Returns false where it decides nothing.
    bool offer_neighbour(const Triangle& triangle, TriangleId id);
    /// Returns exact_candidate(), but nothing for a triangle that was asked before, because leaves
    /// that overlap offer it again.
    std::optional<Candidate> in_doubt(const Triangle& triangle, TriangleId id);
    /// Whether the hit lies behind p.after.
    bool counts(Candidate& found, const Triangle& triangle) {
        return !behind_ || behind_->has(found, triangle);
    }

    const PreparedRay& p_;
    std::optional<Behind> behind_;
    ComparedHit best_;
    std::optional<Recent> decided_; // once in doubt; each is the best, or has lost
};

/// Returns the hit of a single triangle, rounded once.
std::optional<Hit> intersect(const PreparedRay& p, const Triangle& triangle, TriangleId id);

/// The part of a ray inside something: empty when enter > exit.
struct Interval {
    double enter;
    double exit;

    bool empty() const { return !(enter <= exit); }
};

/// Returns the part of [from, to] that the ray spends in `box`. It may be a little too long, but is
/// never too short when the box was padded by PreparedRay::margin.
inline Interval clip(const PreparedRay& p, const Box& box, double from, double to) {
    for (int axis = 0; axis < 3; ++axis) {
        const double org = p.ray.org[axis];
        if (p.ray.dir[axis] == 0) {
            if (org < box.lo[axis] || org > box.hi[axis])
                return {1, 0};
            continue;
        }
        double near = (box.lo[axis] - org) * p.inv_dir[axis];
        double far = (box.hi[axis] - org) * p.inv_dir[axis];
        if (p.inv_dir[axis] < 0)
            std::swap(near, far);
        // A NaN (0 times infinity: dir is denormal, org on the face) leaves the bound as it was.
        from = near > from ? near : from;
        to = far < to ? far : to;
    }
    return {from, to};
}

} // namespace ovc
