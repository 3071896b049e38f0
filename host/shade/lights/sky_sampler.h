// SPDX-License-Identifier: Apache-2.0
// SkySampler chooses directions of the sky for path tracing, bright ones more often than dark
// ones.
#pragma once

#include "core/scene.h"

#include <vector>

namespace ovc {

/// A direction of the sky.
struct SkySample {
    dvec3 direction; // of unit length
    double density;  // with which it is chosen, by solid angle; above 0
};

class SkySampler {
public:
    /// up: of the background. The scene need not outlive it.
    SkySampler(const Scene& scene, const vec3& up);

    /// Returns whether there is a picture in the sky, and it sends light. If not, nothing below may
    /// be called.
    bool shines() const { return !rows_.empty(); }
    /// Returns the mean luminance of the sky.
    double mean() const { return mean_; }

    /// u: in [0, 1)^2.
    SkySample sample(const dvec2& u) const;
    /// Returns the density with which sample() chooses this direction, of unit length.
    double density(const dvec3& direction) const;

private:
    double mean_ = 0;
    std::vector<double> rows_;    // running sums of the chances of rows, from +z down; ends with 1
    std::vector<double> columns_; // likewise within each row, around z from +x over +y
};

} // namespace ovc
