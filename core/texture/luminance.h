// SPDX-License-Identifier: Apache-2.0
// How bright a color of linear light is to the eye.
#pragma once

#include "core/vec.h"

namespace ovc {

/// Returns the luminance of a color with the primaries of sRGB (ITU-R BT.709, item 3.2); of white
/// it is 1.
inline double luminance(const vec3& color) {
    return 0.2126 * double(color.x) + 0.7152 * double(color.y) + 0.0722 * double(color.z);
}

} // namespace ovc
