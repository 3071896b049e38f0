// SPDX-License-Identifier: Apache-2.0
// Image: float RGBA, linear light, and the one image metric.
#pragma once

#include "core/vec.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

/// Rows from top to bottom, pixels from left to right.
struct Image {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<vec4> pixels; // width x height

    Image() = default;
    Image(uint32_t w, uint32_t h) : width(w), height(h), pixels(size_t(w) * h, vec4(0)) {}

    vec4& at(uint32_t x, uint32_t y) {
        assert(x < width && y < height);
        return pixels[size_t(y) * width + x];
    }
    const vec4& at(uint32_t x, uint32_t y) const {
        assert(x < width && y < height);
        return pixels[size_t(y) * width + x];
    }
};

/// Covers all channels of all pixels; `differing` counts pixels that compare unequal, as NaN does.
struct ImageDifference {
    double max = 0;
    double rmse = 0;
    uint64_t differing = 0;
};

/// Returns how far two images of one size differ.
ImageDifference difference(const Image& a, const Image& b);

} // namespace ovc
