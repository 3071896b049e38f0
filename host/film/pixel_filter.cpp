// SPDX-License-Identifier: Apache-2.0
// A filter is sampled by its inverted running sum, over steps in which its weight hardly changes.
#include "host/film/pixel_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

/// Even, so that the middle lies between two steps.
static constexpr int kFilterSteps = 512;

double default_radius(FilterOptions::Kind kind) {
    return kind == FilterOptions::Kind::Flat ? 0.5 : 1.5;
}

double filter_weight(FilterOptions::Kind kind, double at) {
    if (!(std::abs(at) <= 1))
        return 0;
    using std::numbers::pi;
    switch (kind) {
    case FilterOptions::Kind::Flat:
        return 1;
    case FilterOptions::Kind::Gaussian: {
        const double end = std::exp(-4.5); // three deviations away
        return (std::exp(-4.5 * at * at) - end) / (1 - end);
    }
    case FilterOptions::Kind::BlackmanHarris:
        return 0.35875 + 0.48829 * std::cos(pi * at) + 0.14128 * std::cos(2 * pi * at) +
               0.01168 * std::cos(3 * pi * at);
    }
    return 0;
}

PixelFilter::PixelFilter(const FilterOptions& options) : options_(options) {
    assert(options.radius > 0);
    if (options.kind == FilterOptions::Kind::Flat)
        return;
    sums_.push_back(0);
    for (int step = 0; step < kFilterSteps; ++step)
        sums_.push_back(sums_.back() +
                        filter_weight(options.kind, (2 * step + 1.0) / kFilterSteps - 1));
    for (double& sum : sums_)
        sum /= sums_.back();
}

/// Returns the distance from the pixel's middle, in radii.
double PixelFilter::offset(double u) const {
    if (sums_.empty())
        return 2 * u - 1;
    const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, u);
    const double before = above[-1], share = (u - before) / (*above - before);
    return 2 * (double(above - sums_.begin() - 1) + share) / kFilterSteps - 1;
}

dvec2 PixelFilter::place(const dvec2& u) const {
    if (options_ == FilterOptions{}) // exactly u, which the sum below might round
        return u;
    return 0.5 + options_.radius * dvec2(offset(u.x), offset(u.y));
}

} // namespace ovc
