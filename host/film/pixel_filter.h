// SPDX-License-Identifier: Apache-2.0
// PixelFilter places a pixel's samples as densely as its reconstruction filter weighs the picture,
// so that each sample counts the same, belongs to one pixel, and pixels stay independent.
// Based on: Ernst, Stamminger and Greiner 2006, "Filter Importance Sampling".
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <vector>

namespace ovc {

struct FilterOptions {
    enum class Kind : uint8_t {
        Flat,          // the box filter
        Gaussian,      // of deviation radius / 3, lowered so that it ends at 0
        BlackmanHarris // the window of four terms of Harris 1978
    };

    Kind kind = Kind::Flat;
    double radius = 0.5; // in pixels, across and down; above 0

    bool operator==(const FilterOptions&) const = default;
};

/// The radius of a filter whose user gives none: half a pixel for a box, 1.5 pixels for others.
double default_radius(FilterOptions::Kind kind);

/// Returns the filter's weight at a place from -1, its left or upper end, to 1; at 0 it is 1.
double filter_weight(FilterOptions::Kind kind, double at);

class PixelFilter {
public:
    explicit PixelFilter(const FilterOptions& options = {});

    /// Returns where in the pixel's coordinates, from (0, 0) top left to (1, 1), a sample lies; it
    /// may lie outside of the pixel. u: from [0, 1)^2, uniform; (0.5, 0.5) gives the middle.
    dvec2 place(const dvec2& u) const;

private:
    double offset(double u) const;

    const FilterOptions options_;
    std::vector<double> sums_; // of the weights from -1 on, as shares of all; empty: a box
};

} // namespace ovc
