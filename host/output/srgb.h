// SPDX-License-Identifier: Apache-2.0
// sRGB's curve between linear light and the codes of picture files.
// Source: IEC 61966-2-1.
#pragma once

#include <algorithm>
#include <cmath>

namespace ovc {

/// Returns the code of linear light, both 0 to 1. Light beyond that counts as the nearest end, and
/// NaN as 0.
inline float srgb_code(float linear) {
    const float clamped = linear > 0 ? std::min(linear, 1.0f) : 0.0f;
    return clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
}

/// Returns the linear light of a code from 0 to 1.
inline float srgb_light(float code) {
    return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

} // namespace ovc
