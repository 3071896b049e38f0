// SPDX-License-Identifier: Apache-2.0
// Finds the nearest hit by testing every triangle in integers, which Boost multiplies. It shares no
// code with the library, so the answers of the C ABI are compared with it.
#pragma once

#include "plugin/overcast.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace ovc::oracle {

using Integer = boost::multiprecision::cpp_int;
using Corner = std::array<double, 3>;

struct Triangle {
    std::array<Corner, 3> corners;
    ovc_triangle id;
};

class Oracle {
public:
    /// Corners must be finite. Triangles without area are left out.
    explicit Oracle(std::vector<Triangle> triangles);

    /// Returns the answer that overcast.h promises: t, u and v are the exact values, each rounded
    /// to the nearest double. skip: a triangle that the ray does not see.
    ovc_hit nearest(const ovc_ray& ray, ovc_triangle skip = {OVC_NONE, OVC_NONE}) const;
    /// Returns all hits of the ray in the order of exact t, mesh and prim, rounded likewise.
    std::vector<ovc_hit> all_hits(const ovc_ray& ray) const;
    /// Returns the first hit behind the place `after`, as ovc_query.after defines it.
    ovc_hit next(const ovc_ray& ray, const ovc_hit& after) const;

    size_t triangle_count() const { return triangles_.size(); }
    uint64_t exact_tests() const { return exact_tests_; }

private:
    struct ExactRay;
    struct ExactHit;
    std::vector<ExactHit> sorted_hits(const ovc_ray& ray, const ExactRay& exact) const;
    std::optional<ExactHit> meet(const ExactRay& ray, const Triangle& triangle) const;

    std::vector<Triangle> triangles_;
    int lowest_bit_ = 0; // All corners are multiples of 2^lowest_bit_.
    mutable uint64_t exact_tests_ = 0;
};

} // namespace ovc::oracle
