// SPDX-License-Identifier: Apache-2.0
// PixelSource: the pixels of an image that are made as they are asked for, so that large images
// need not lie in memory.
#pragma once

#include "core/file/image.h"

#include <functional>
#include <span>

namespace ovc {

struct PixelSource {
    uint32_t width = 0, height = 0;
    /// Writes the pixels from number `first` on, in rows from the top, first + pixels.size() <=
    /// size(). Any number of threads may call it.
    std::function<void(size_t first, std::span<vec4> pixels)> read;

    PixelSource(uint32_t w, uint32_t h, std::function<void(size_t, std::span<vec4>)> r)
        : width(w), height(h), read(std::move(r)) {}
    /// The image outlives the source.
    PixelSource(const Image& image);

    size_t size() const { return size_t(width) * height; }
};

/// Returns all of the pixels.
Image image_of(const PixelSource& source);

} // namespace ovc
