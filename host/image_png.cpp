// SPDX-License-Identifier: Apache-2.0
// PNG out: 8 bits a channel, sRGB, as a viewer expects. PNG in, of POV-Ray scenes:
// importers/pov/picture_png.cpp.
#include "host/output.h"

#include "core/parallel.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

namespace ovc {

/// IEC 61966-2-1, from linear light to the 8-bit code. NaN comes out black.
static uint8_t srgb_code(float linear) {
    const float clamped = linear > 0 ? std::min(linear, 1.0f) : 0.0f;
    const float coded =
        clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
    return uint8_t(std::lround(coded * 255));
}

static std::vector<uint8_t> srgb_rows(const Image& image) {
    std::vector<uint8_t> rows(image.pixels.size() * 3);
    parallel_for(image.pixels.size(), 4096, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            for (int channel = 0; channel < 3; ++channel)
                rows[i * 3 + size_t(channel)] = srgb_code(image.pixels[i][channel]);
    });
    return rows;
}

Result<std::string> encode_png(const Image& image) {
    const std::vector<uint8_t> rows = srgb_rows(image);
    char* text = nullptr;
    size_t size = 0;
    FILE* const file = open_memstream(&text, &size);
    if (!file)
        return Error{std::strerror(errno)};

    // libpng's simplified interface reports errors in `header` instead of jumping out of this
    // function.
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = image.width;
    header.height = image.height;
    header.format = PNG_FORMAT_RGB;
    const bool written = png_image_write_to_stdio(&header, file, /* convert_to_8_bit= */ 0,
                                                  rows.data(), int32_t(image.width * 3), nullptr);
    const bool closed = std::fclose(file) == 0; // only now text and size are final
    const std::unique_ptr<char, void (*)(void*)> owner(text, std::free);
    if (!written || !closed)
        return Error{written ? "out of memory" : header.message};
    return std::string(text, size);
}

} // namespace ovc
