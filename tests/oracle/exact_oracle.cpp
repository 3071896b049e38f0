// SPDX-License-Identifier: Apache-2.0
// Applies Cramer's rule to org + t dir = a + u ab + v ac, in integers after scaling by powers of
// two.
#include "tests/oracle/exact_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ovc::oracle {
namespace {

// On x86, this has 64 bits of mantissa. A filter with it leaves few rays to integers.
using Long = long double;
using IntegerVec = std::array<Integer, 3>;
using LongVec = std::array<Long, 3>;

/// Returns the exponent of the lowest bit that is set, or a large number for 0.
int lowest_bit(double x) {
    if (x == 0)
        return std::numeric_limits<int>::max() / 2;
    int exponent = 0;
    double mantissa = std::frexp(x, &exponent);
    int bits = 0;
    while (mantissa != std::floor(mantissa)) {
        mantissa *= 2;
        ++bits;
    }
    return exponent - bits;
}

/// Returns x / 2^bit, which is an integer.
Integer whole(double x, int bit) {
    if (x == 0)
        return 0;
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    Integer result = static_cast<long long>(std::ldexp(mantissa, 53));
    const int shift = exponent - 53 - bit;
    return shift >= 0 ? Integer(result << shift) : Integer(result >> -shift);
}

template <class Vec>
Vec minus(const Vec& a, const Vec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Vec>
Vec cross(const Vec& a, const Vec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class Vec>
typename Vec::value_type dot(const Vec& a, const Vec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
LongVec size(const LongVec& v) {
    return {std::abs(v[0]), std::abs(v[1]), std::abs(v[2])};
}
LongVec cross_size(const LongVec& a, const LongVec& b) {
    return {a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]};
}

IntegerVec wholes(const double* v, int bit) {
    return {whole(v[0], bit), whole(v[1], bit), whole(v[2], bit)};
}
LongVec longs(const double* v) {
    return {v[0], v[1], v[2]};
}

/// Returns numerator / denominator 2^exponent as the nearest double, ties to even. denominator > 0.
double rounded(const Integer& numerator, const Integer& denominator, int exponent) {
    if (numerator == 0)
        return 0;
    const bool negative = numerator < 0;
    const Integer n = abs(numerator);
    // The quotient has 60 bits or more; `rest` tells whether anything is left behind it.
    int shift = 60 + int(msb(denominator)) - int(msb(n));
    shift = std::max(shift, 0);
    Integer quotient, rest;
    divide_qr(Integer(n << shift), denominator, quotient, rest);
    int bit = exponent - shift; // the exponent of the quotient's last place
    const int keep =
        // These bits do not fit a double.
        std::max(int(msb(quotient)) - 52, -1074 - bit);
    if (keep > 0) {
        const Integer half = Integer(1) << (keep - 1);
        const Integer low = quotient & ((Integer(1) << keep) - 1);
        quotient >>= keep;
        bit += keep;
        const bool tie = low == half && rest == 0;
        if (low > half || (low == half && rest != 0) || (tie && (quotient & 1) != 0))
            quotient += 1;
    }
    const double value = std::ldexp(quotient.convert_to<double>(), bit);
    return negative ? -value : value;
}

/// Returns whether a triangle certainly is not hit, or not before `limit`. All bounds are wide.
/// t_bound: receives a t before which it certainly is hit, or infinity.
bool certainly_out(const ovc_ray& ray, const Triangle& t, Long limit, Long& t_bound) {
    constexpr Long kError = 0x1p-56L;
    const LongVec a = longs(t.corners[0].data());
    const LongVec ab = minus(longs(t.corners[1].data()), a);
    const LongVec ac = minus(longs(t.corners[2].data()), a);
    const LongVec s = minus(longs(ray.org), a), dir = longs(ray.dir);
    const LongVec p = cross(dir, ac), q = cross(s, ab);
    const LongVec p_size = cross_size(size(dir), size(ac)), q_size = cross_size(size(s), size(ab));
    Long det = dot(ab, p), u = dot(s, p), v = dot(dir, q), depth = dot(ac, q);
    if (det < 0) {
        det = -det;
        u = -u;
        v = -v;
        depth = -depth;
    }
    const Long det_error = kError * dot(size(ab), p_size), u_error = kError * dot(size(s), p_size);
    const Long v_error = kError * dot(size(dir), q_size);
    const Long depth_error = kError * dot(size(ac), q_size);
    t_bound = std::numeric_limits<Long>::infinity();
    if (!(det > 4 * det_error))
        return false; // Its sign is not known.
    if (u < -u_error || v < -v_error || u + v - det > u_error + v_error + det_error)
        return true;
    if (!(depth > 2 * depth_error))
        return false; // It may lie behind.
    const Long least = (depth - depth_error) / (det + det_error);
    const Long most = (depth + depth_error) / (det - det_error);
    if (least > limit * (1 + 1e-15L))
        return true;
    const bool inside = u > u_error && v > v_error && det - u - v > u_error + v_error + det_error;
    if (inside && least > Long(ray.t_min) && most < Long(ray.t_max))
        t_bound = most;
    return false;
}

/// Returns the sign of t / det 2^exponent - end.
int compare(const Integer& t, const Integer& det, int exponent, double end) {
    const int bit = std::min(exponent, end == 0 ? exponent : lowest_bit(end));
    return Integer(t << (exponent - bit)).compare(Integer(det * whole(end, bit)));
}

} // namespace

constexpr ovc_hit kMiss = {std::numeric_limits<double>::infinity(), 0, 0, OVC_NONE, OVC_NONE};

struct Oracle::ExactHit {
    Integer t, u, v, det; // det > 0
    ovc_triangle id;

    bool operator<(const ExactHit& other) const {
        const int order = Integer(t * other.det).compare(Integer(other.t * det));
        return order != 0 ? order < 0
                          : std::pair(id.mesh, id.prim) < std::pair(other.id.mesh, other.id.prim);
    }
    ovc_hit rounded(int exponent) const {
        return {oracle::rounded(t, det, exponent), oracle::rounded(u, det, 0),
                oracle::rounded(v, det, 0), id.mesh, id.prim};
    }
};

/// A ray in integers.
struct Oracle::ExactRay {
    ExactRay(const ovc_ray& ray, int lowest_bit_of_corners)
        : length_bit(lowest_bit_of_corners), t_min(ray.t_min) {
        int dir_bit = std::numeric_limits<int>::max() / 2;
        for (int axis = 0; axis < 3; ++axis) {
            length_bit = std::min(length_bit, lowest_bit(ray.org[axis]));
            dir_bit = std::min(dir_bit, lowest_bit(ray.dir[axis]));
        }
        exponent = length_bit - dir_bit; // t counts lengths in units of directions.
        // No hit is reported beyond the largest double.
        t_max = std::min(ray.t_max, std::numeric_limits<double>::max());
        org = wholes(ray.org, length_bit);
        dir = wholes(ray.dir, dir_bit);
    }

    int length_bit, exponent;
    double t_min, t_max;
    IntegerVec org, dir;
};

Oracle::Oracle(std::vector<Triangle> triangles) {
    lowest_bit_ = std::numeric_limits<int>::max() / 2;
    for (const Triangle& t : triangles)
        for (const Corner& corner : t.corners)
            for (const double x : corner)
                lowest_bit_ = std::min(lowest_bit_, lowest_bit(x));
    for (const Triangle& t : triangles) {
        const IntegerVec a = wholes(t.corners[0].data(), lowest_bit_);
        const IntegerVec normal = cross(minus(wholes(t.corners[1].data(), lowest_bit_), a),
                                        minus(wholes(t.corners[2].data(), lowest_bit_), a));
        if (normal[0] != 0 || normal[1] != 0 || normal[2] != 0)
            triangles_.push_back(t);
    }
}

ovc_hit Oracle::nearest(const ovc_ray& ray, ovc_triangle skip) const {
    const ExactRay exact(ray, lowest_bit_);
    std::optional<ExactHit> best;
    Long limit = exact.t_max;
    std::vector<const Triangle*> left;
    for (const Triangle& triangle : triangles_) {
        Long t_bound = 0;
        if ((triangle.id.mesh == skip.mesh && triangle.id.prim == skip.prim) ||
            certainly_out(ray, triangle, limit, t_bound))
            continue;
        limit = std::min(limit, t_bound);
        left.push_back(&triangle);
    }
    for (const Triangle* triangle : left) {
        Long t_bound = 0;
        if (certainly_out(ray, *triangle, limit, t_bound))
            continue;
        const std::optional<ExactHit> hit = meet(exact, *triangle);
        if (hit && (!best || *hit < *best))
            best = hit;
    }
    return best ? best->rounded(exact.exponent) : kMiss;
}

std::vector<ovc_hit> Oracle::all_hits(const ovc_ray& ray) const {
    const ExactRay exact(ray, lowest_bit_);
    std::vector<ovc_hit> hits;
    for (const ExactHit& hit : sorted_hits(ray, exact))
        hits.push_back(hit.rounded(exact.exponent));
    return hits;
}

ovc_hit Oracle::next(const ovc_ray& ray, const ovc_hit& after) const {
    const ExactRay exact(ray, lowest_bit_);
    const std::vector<ExactHit> hits = sorted_hits(ray, exact);
    const auto is_named = [&](const ExactHit& hit) {
        return hit.id.mesh == after.mesh && hit.id.prim == after.prim &&
               hit.rounded(exact.exponent).t == after.t;
    };
    const auto is_behind = [&](const ExactHit& hit) {
        if (!std::isfinite(after.t))
            return after.t < 0;
        const int order = compare(hit.t, hit.det, exact.exponent, after.t);
        return order != 0 ? order > 0
                          : std::pair(hit.id.mesh, hit.id.prim) > std::pair(after.mesh, after.prim);
    };
    auto found = std::find_if(hits.begin(), hits.end(), is_named);
    found = found != hits.end() ? found + 1 : std::find_if(hits.begin(), hits.end(), is_behind);
    return found != hits.end() ? found->rounded(exact.exponent) : kMiss;
}

std::vector<Oracle::ExactHit> Oracle::sorted_hits(const ovc_ray& ray, const ExactRay& exact) const {
    std::vector<ExactHit> found;
    for (const Triangle& triangle : triangles_) {
        Long t_bound = 0;
        if (certainly_out(ray, triangle, exact.t_max, t_bound))
            continue;
        if (std::optional<ExactHit> hit = meet(exact, triangle))
            found.push_back(std::move(*hit));
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::optional<Oracle::ExactHit> Oracle::meet(const ExactRay& ray, const Triangle& triangle) const {
    ++exact_tests_;
    const IntegerVec a = wholes(triangle.corners[0].data(), ray.length_bit);
    const IntegerVec ab = minus(wholes(triangle.corners[1].data(), ray.length_bit), a);
    const IntegerVec ac = minus(wholes(triangle.corners[2].data(), ray.length_bit), a);
    const IntegerVec s = minus(ray.org, a), p = cross(ray.dir, ac), q = cross(s, ab);
    ExactHit hit{dot(ac, q), dot(s, p), dot(ray.dir, q), dot(ab, p), triangle.id};
    if (hit.det == 0)
        return std::nullopt;
    if (hit.det < 0) {
        hit.t = -hit.t;
        hit.u = -hit.u;
        hit.v = -hit.v;
        hit.det = -hit.det;
    }
    if (hit.u < 0 || hit.v < 0 || Integer(hit.u + hit.v) > hit.det ||
        compare(hit.t, hit.det, ray.exponent, ray.t_min) < 0 ||
        compare(hit.t, hit.det, ray.exponent, ray.t_max) > 0)
        return std::nullopt;
    return hit;
}

} // namespace ovc::oracle
