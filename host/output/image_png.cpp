// SPDX-License-Identifier: Apache-2.0
// Writes PNG in sRGB with 8 or 16 bits a channel, as viewers expect it.
#include "host/output/output.h"

#include "core/system/parallel.h"
#include "host/output/srgb.h"
#include "host/terminal/version.h"
#include "importers/png.h"

#include <cassert>
#include <cmath>
#include <vector>

namespace ovc {

/// Returns the sRGB code, rounded to `bits` and scaled to 65535.
static uint16_t sample_of(float linear, int bits) {
    return bits == 16 ? uint16_t(std::lround(srgb_code(linear) * 65535))
                      : uint16_t(srgb_byte(linear) * 257);
}

Result<std::string> encode_png(const PixelSource& image, const FileContents& contents) {
    assert(contents.png_bits == 8 || contents.png_bits == 16);
    const auto read = [&](uint32_t row, std::span<uint16_t> samples) {
        const size_t before = size_t(row) * image.width;
        parallel_for(samples.size() / 3, 4096, [&](size_t first, size_t last) {
            std::vector<vec4> pixels(last - first);
            image.read(before + first, pixels);
            for (size_t i = first; i < last; ++i)
                for (int channel = 0; channel < 3; ++channel)
                    samples[i * 3 + size_t(channel)] =
                        sample_of(pixels[i - first][channel], contents.png_bits);
        });
    };
    // Only the program's name goes into the file, so that the same pixels are the same file.
    return write_png(PngRows{image.width, image.height, contents.png_bits, read},
                     "overcast " + version_text());
}

} // namespace ovc
