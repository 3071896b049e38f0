// SPDX-License-Identifier: Apache-2.0
// ImageDifference: the metric.
#include "core/file/image.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

ImageDifference difference(const Image& a, const Image& b) {
    assert(a.width == b.width && a.height == b.height);
    ImageDifference result;
    double squares = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        result.differing += a.pixels[i] != b.pixels[i];
        for (int channel = 0; channel < 4; ++channel) {
            const double d = double(a.pixels[i][channel]) - double(b.pixels[i][channel]);
            result.max = std::max(result.max, std::abs(d));
            squares += d * d;
        }
    }
    if (!a.pixels.empty())
        result.rmse = std::sqrt(squares / (4.0 * double(a.pixels.size())));
    return result;
}

} // namespace ovc
