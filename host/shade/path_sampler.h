// SPDX-License-Identifier: Apache-2.0
// PathSampler makes the random numbers of path tracing. Each is a function of the seed, the pixel,
// the sample and its purpose alone, whatever the order of calls. Over the samples of a pixel they
// are spread evenly.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace ovc {

class PathSampler {
public:
    PathSampler(uint64_t seed, uint32_t pixel, uint32_t sample);

    /// Returns a point of [0, 1) x [0, 1). The points of one purpose over 2^k samples of a pixel
    /// lie one in each of 2^k equal boxes, of any shape. Points of different purposes are
    /// independent.
    dvec2 pair(uint32_t purpose) const;

private:
    uint64_t pixel_; // a hash of the pixel and the seed
    uint32_t sample_;
};

} // namespace ovc
