// SPDX-License-Identifier: Apache-2.0
// PathSampler: the random numbers of path tracing. Each is a function of the seed, the pixel, the
// sample and what it is for, whoever asks and in whatever order; over the samples of a pixel they
// are spread evenly.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace ovc {

class PathSampler {
public:
    PathSampler(uint64_t seed, uint32_t pixel, uint32_t sample);

    /// A point of [0, 1) x [0, 1). Points of one purpose over 2^k samples of a pixel lie one in
    /// each of 2^k like boxes, of any shape; points of different purposes have nothing to do with
    /// each other.
    dvec2 pair(uint32_t purpose) const;

private:
    uint64_t pixel_; // and the seed, hashed
    uint32_t sample_;
};

} // namespace ovc
