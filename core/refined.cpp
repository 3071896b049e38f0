// SPDX-License-Identifier: Apache-2.0
// The determinants of ExactTriangle in doubled precision. The bounds: docs/numerics.md, "The
// reference".
#include "core/refined.h"

#include "core/double_double.h"

namespace ovc {
namespace {

constexpr double v = 0x1p-53;
constexpr double kLargest = 1e90;     // beyond, products of three might overflow
constexpr double kUnderflow = 1e-200; // more than all that underflows below kLargest

/// A corner seen from the ray's origin, exactly, and its cross product with the direction: how far
/// the corner is from the ray's line.
struct Corner {
    DoubleDoubleVec at;
    DoubleDoubleVec off;
    dvec3 off_size; // magnitudes of the products in `off`, added up

    Corner(const dvec3& position, const dvec3& org, const dvec3& dir)
        : at(two_difference(position, org)), off(cross(at, dir)) {
        const dvec3 size(std::abs(at[0].hi), std::abs(at[1].hi), std::abs(at[2].hi));
        const dvec3 d = glm::abs(dir);
        off_size = {size.y * d.z + size.z * d.y, size.z * d.x + size.x * d.z,
                    size.x * d.y + size.y * d.x};
    }

    /// Does the ray's line go through the corner? Where `at` has no low parts, the products that
    /// `off` subtracts are exact, and only equal ones leave nothing. No, where that is not clear.
    bool on_the_line() const {
        constexpr DoubleDouble zero;
        return at[0].lo == 0 && at[1].lo == 0 && at[2].lo == 0 && off[0] == zero &&
               off[1] == zero && off[2] == zero;
    }
};

/// A number and what it is off by at most.
struct Bounded {
    DoubleDouble value;
    double error = 0;

    /// -1 or 1; 0 where it is not known, or is exactly 0.
    int sign() const { return value.hi > error ? 1 : value.hi < -error ? -1 : 0; }
    bool is_precise() const { return error <= 0.5 * v * std::abs(value.hi); }
};

/// A ray's triangle: its corners, and the weights that say on which side of each side the ray is.
class Refined {
public:
    Refined(const PreparedRay& p, const Triangle& triangle)
        : p_(p),
          triangle_(triangle),
          dir_(scaled_direction(p)),
          corner_{Corner(triangle[0], p.ray.org, dir_), Corner(triangle[1], p.ray.org, dir_),
                  Corner(triangle[2], p.ray.org, dir_)} {}

    RefinedAnswer answer(TriangleId id) {
        for (int k = 0; k < 3; ++k)
            if (corner_[k].on_the_line())
                return at_corner(k, id);
        for (int i = 0; i < 3; ++i)
            weights_[i] = weight(i);
        for (int i = 0; i < 3; ++i) {
            if (outside())
                return {true, std::nullopt};
            if (weights_[i].sign() == 0)
                weights_[i] = exact_weight(i);
        }
        const bool edge_on =
            weights_[0].sign() == 0 && weights_[1].sign() == 0 && weights_[2].sign() == 0;
        return outside() || edge_on ? RefinedAnswer{true, std::nullopt} : inside(id);
    }

private:
    /// (a - b) . (b x dir) for the corners a and b after i, seen from the ray's origin: as
    /// ExactTriangle has it, a . (b x dir).
    Bounded weight(int i) const {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const DoubleDoubleVec side = two_difference(triangle_[a], triangle_[b]);
        double size = 0;
        for (int axis = 0; axis < 3; ++axis)
            size += std::abs(side[axis].hi) * corner_[b].off_size[axis];
        return {dot(side, corner_[b].off), 32 * v * v * size + kUnderflow};
    }

    Bounded exact_weight(int i) const {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        const Expansion exact =
            dot(exact_difference(triangle_[a], triangle_[b]),
                cross(exact_difference(triangle_[b], p_.ray.org), exact_vector(dir_)));
        const DoubleDouble rounded = exact.rounded();
        return {rounded, 0x1p-96 * std::abs(rounded.hi)};
    }

    bool outside() const {
        bool positive = false, negative = false;
        for (const Bounded& weight : weights_) {
            positive |= weight.sign() > 0;
            negative |= weight.sign() < 0;
        }
        return positive && negative;
    }

    /// The line goes through corner k: the other weights are zero, and t is the corner's own.
    RefinedAnswer at_corner(int k, TriangleId id) const {
        Bounded area = weight(k);
        if (area.sign() == 0)
            area = exact_weight(k);
        if (area.sign() == 0)
            return {true, std::nullopt}; // edge-on
        return hit(corner_[k].at[p_.kz].hi / p_.ray.dir[p_.kz], k == 1, k == 2, id, 1u << k);
    }

    RefinedAnswer inside(TriangleId id) const {
        Bounded area, depth{{}, kUnderflow};
        uint32_t support = 0;
        for (int i = 0; i < 3; ++i) {
            const auto& [w, error] = weights_[i];
            const DoubleDouble& z = corner_[i].at[p_.kz];
            area.value = area.value + w;
            area.error += error + 16 * v * v * std::abs(w.hi);
            depth.value = depth.value + w * z;
            depth.error += (error + 32 * v * v * std::abs(w.hi)) * std::abs(z.hi);
            support |= uint32_t(weights_[i].sign() != 0) << i;
        }
        if (!area.is_precise() || !depth.is_precise())
            return {};
        return hit(depth.value.hi / area.value.hi / p_.ray.dir[p_.kz],
                   weights_[1].value.hi / area.value.hi, weights_[2].value.hi / area.value.hi, id,
                   support);
    }

    /// A hit of the line at t, off by a few roundings: known where it is clearly within the ray, or
    /// clearly not.
    RefinedAnswer hit(double t, double weight_b, double weight_c, TriangleId id,
                      uint32_t support) const {
        const double error = kRefinedError * std::abs(t);
        if (t + error < p_.ray.t_min || t - error > p_.ray.t_max)
            return {true, std::nullopt};
        if (!(t - error >= p_.ray.t_min && t + error <= p_.ray.t_max))
            return {};
        return {true, Candidate{{t, weight_b, weight_c, id}, error, support}};
    }

    const PreparedRay& p_;
    const Triangle& triangle_;
    dvec3 dir_;
    std::array<Corner, 3> corner_;
    std::array<Bounded, 3> weights_;
};

bool in_range(const Triangle& triangle, const dvec3& org) {
    double largest = max_component(glm::abs(org));
    for (const dvec3& corner : triangle)
        largest = std::max(largest, max_component(glm::abs(corner)));
    return largest < kLargest;
}

} // namespace

dvec3 scaled_direction(const PreparedRay& p) {
    int exponent = 0;
    std::frexp(p.ray.dir[p.kz], &exponent);
    return {std::ldexp(p.ray.dir.x, -exponent), std::ldexp(p.ray.dir.y, -exponent),
            std::ldexp(p.ray.dir.z, -exponent)};
}

RefinedAnswer refined_candidate(const PreparedRay& p, const Triangle& triangle, TriangleId id) {
    if (!in_range(triangle, p.ray.org))
        return {};
    return Refined(p, triangle).answer(id);
}

} // namespace ovc
