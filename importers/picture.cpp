// SPDX-License-Identifier: Apache-2.0
#include "importers/picture.h"

#include <fmt/format.h>

namespace ovc {

Result<Picture> make_picture(uint64_t width, uint64_t height) {
    if (width == 0 || height == 0 || width > kMaxPixels || height > kMaxPixels / width)
        return Error{fmt::format("found a picture of {} x {}, expected 1 to {} pixels", width,
                                 height, kMaxPixels)};
    Picture picture;
    picture.width = uint32_t(width);
    picture.height = uint32_t(height);
    return picture;
}

} // namespace ovc
