// SPDX-License-Identifier: Apache-2.0
// FLIP measures how different two pictures look to a person who sees one after the other in the
// same place. Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild 2020,
// "FLIP: A Difference Evaluator for Alternating Images".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The paper's viewer: 0.7 m from a screen that is 0.7 m and 3840 pixels wide.
inline constexpr double kPixelsPerDegree = 3840 * 3.14159265358979323846 / 180;

/// Red, green and blue as codes of sRGB, 0 to 1. Each plane is width x height, rows from the top.
struct SrgbPlanes {
    uint32_t width = 0;
    uint32_t height = 0;
    std::span<const float> red, green, blue;
};

/// Returns LDR-FLIP's error of each pixel, 0 to 1; 0 where both look the same. Codes beyond 0 to 1
/// count as the nearest end, and NaN as 0. The pictures are of one size (asserted).
std::vector<float> flip_errors(const SrgbPlanes& a, const SrgbPlanes& b,
                               double pixels_per_degree = kPixelsPerDegree);

} // namespace ovc
