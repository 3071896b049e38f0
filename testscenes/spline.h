// SPDX-License-Identifier: Apache-2.0
// Smooth curves near a few points, which are uniform cubic B-splines.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>

namespace ovc {

/// Returns the curve at `along` in [0, 1]. It begins at the first point, ends at the last, and
/// passes near those between. T: any type with + and a product with a double.
template <class T>
T spline_at(std::span<const T> points, double along) {
    assert(!points.empty());
    const auto last = int64_t(points.size()) - 1;
    // Both ends count three times, so that the curve begins and ends there.
    const double s = std::clamp(along, 0.0, 1.0) * double(last + 2);
    const int64_t segment = std::min(int64_t(s), last + 1);
    const double f = s - double(segment), g = 1 - f;
    const std::array<double, 4> weights = {g * g * g, (3 * f - 6) * f * f + 4,
                                           (3 * g - 6) * g * g + 4, f * f * f};
    const auto point = [&](int64_t k) {
        return points[size_t(std::clamp<int64_t>(segment + k - 2, 0, last))];
    };
    T sum = (weights[0] / 6) * point(0);
    for (int64_t k = 1; k < 4; ++k)
        sum = sum + (weights[size_t(k)] / 6) * point(k);
    return sum;
}

} // namespace ovc
