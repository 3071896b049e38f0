// SPDX-License-Identifier: Apache-2.0
// PixelSource: an image as a source, and a source as an image.
#include "core/file/pixel_source.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>

namespace ovc {

PixelSource::PixelSource(const Image& image)
    : width(image.width),
      height(image.height),
      read([&image](size_t first, std::span<vec4> pixels) {
          assert(first + pixels.size() <= image.pixels.size());
          std::copy_n(image.pixels.begin() + ptrdiff_t(first), pixels.size(), pixels.begin());
      }) {}

Image image_of(const PixelSource& source) {
    Image image(source.width, source.height);
    parallel_for(image.pixels.size(), 4096, [&](size_t first, size_t last) {
        source.read(first, std::span(image.pixels).subspan(first, last - first));
    });
    return image;
}

} // namespace ovc
