// SPDX-License-Identifier: Apache-2.0
// PicturePart: where the pixels of a film lie in its picture.
#pragma once

#include "core/scene.h"

#include <cstdint>

namespace ovc {

/// A part of a larger picture, at `left` and `top` pixels from its left and upper edge.
struct PicturePart {
    ImageSize picture;
    uint32_t left = 0;
    uint32_t top = 0;
    ImageSize size;

    /// Returns the number in the picture of a pixel of the part, both counted row by row. Random
    /// numbers go by it, so that a part has the noise of the whole picture.
    uint32_t number_in_picture(uint32_t pixel) const {
        return (top + pixel / size.width) * picture.width + left + pixel % size.width;
    }
};

} // namespace ovc
