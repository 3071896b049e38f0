// SPDX-License-Identifier: Apache-2.0
// The reference: rays against triangles and boxes in double. What it answers is what certified mode
// returns. Based on: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", section
// 3; Ize 2013, "Robust BVH Ray Traversal", section 3. Needs -ffp-contract=off: a fused multiply-add
// would break the antisymmetry of the edge functions.
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "core/soup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace ovc {

/// A ray made ready: the basis that maps it onto the z axis, and the margin that keeps box tests
/// conservative.
struct PreparedRay {
    Ray ray;
    int kx, ky, kz;    // kz: the major axis of dir
    double sx, sy, sz; // shear and scale of Woop et al. 2013, section 3.1
    dvec3 inv_dir;     // may be infinite
    TriangleId skip;   // a triangle this ray does not see: the one it starts on

    explicit PreparedRay(const Ray& r, TriangleId skipped = {}) : ray(r), skip(skipped) {
        kz = major_axis(r.dir);
        kx = (kz + 1) % 3;
        ky = (kz + 2) % 3;
        sx = r.dir[kx] / r.dir[kz];
        sy = r.dir[ky] / r.dir[kz];
        sz = 1.0 / r.dir[kz];
        inv_dir = dvec3(1.0) / r.dir;
    }

    /// More than the rounding error, in each coordinate, of positions along this ray within
    /// `bounds`.
    double margin(const Box& bounds) const {
        return 0x1p-46 * max_component(glm::max(glm::abs(bounds.lo - ray.org),
                                                glm::abs(bounds.hi - ray.org)));
    }
};

/// Where the ray meets the triangle, t_min <= t <= t_max; nothing where it does not. Edges and
/// vertices belong to every triangle they bound, so a ray never slips between two triangles that
/// share corners bit for bit: the two products of an edge function round monotonically, so its sign
/// is right or zero, and zero counts as inside. A triangle seen exactly edge-on is not hit.
inline std::optional<Hit> intersect(const PreparedRay& p, const Triangle& triangle, TriangleId id) {
    double x[3], y[3], z[3];
    for (int i = 0; i < 3; ++i) {
        const dvec3 d = triangle[i] - p.ray.org;
        x[i] = d[p.kx] - p.sx * d[p.kz];
        y[i] = d[p.ky] - p.sy * d[p.kz];
        z[i] = d[p.kz];
    }
    const double a = x[2] * y[1] - y[2] * x[1];
    const double b = x[0] * y[2] - y[0] * x[2];
    const double c = x[1] * y[0] - y[1] * x[0];
    if ((a < 0 || b < 0 || c < 0) && (a > 0 || b > 0 || c > 0))
        return std::nullopt;
    const double det = a + b + c;
    if (det == 0)
        return std::nullopt;
    const double u = b / det;
    const double v = c / det;
    const double t = (a * z[0] + b * z[1] + c * z[2]) / det * p.sz;
    if (!(t >= p.ray.t_min && t <= p.ray.t_max) || id == p.skip)
        return std::nullopt;
    return Hit{t, u, v, id};
}

/// The part of a ray inside something: empty when enter > exit.
struct Interval {
    double enter;
    double exit;

    bool empty() const { return !(enter <= exit); }
};

/// The part of [from, to] that the ray spends in `box`. May be a little too long, never too short,
/// when the box was padded by PreparedRay::margin.
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
