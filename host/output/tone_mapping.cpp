// SPDX-License-Identifier: Apache-2.0
// The curves of tone mapping, and the exposure that suits a picture.
#include "host/output/tone_mapping.h"

#include "core/scene.h"
#include "core/texture/luminance.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ovc {

static constexpr size_t kPixelsAtOnce = 4096;
/// The reflectance of a photographer's grey card.
static constexpr double kMiddleGrey = 0.18;

double automatic_stops(const PixelSource& image) {
    double sum = 0;
    uint64_t count = 0;
    std::vector<vec4> pixels(kPixelsAtOnce);
    for (size_t first = 0; first < image.size(); first += pixels.size()) {
        pixels.resize(std::min(kPixelsAtOnce, image.size() - first));
        image.read(first, pixels);
        for (const vec4& pixel : pixels)
            if (const double light = luminance(vec3(pixel)); light > 0 && std::isfinite(light)) {
                sum += std::log2(light);
                ++count;
            }
    }
    return count > 0 ? std::log2(kMiddleGrey) - sum / double(count) : 0;
}

void to_linear(std::span<vec4> pixels, double gamma) {
    for (vec4& pixel : pixels)
        for (int i = 0; i < 3; ++i)
            pixel[i] = linear_light(pixel[i], gamma);
}

void expose(std::span<vec4> pixels, double stops) {
    const float factor = float(std::exp2(stops));
    for (vec4& pixel : pixels)
        pixel = vec4(factor * vec3(pixel), pixel.a);
}

/// Hable's curve before it is scaled to white.
static float hable(float x) {
    constexpr float kShoulder = 0.15f, kLinear = 0.5f, kAngle = 0.1f, kToe = 0.2f,
                    kToeNumerator = 0.02f, kToeDenominator = 0.3f;
    return (x * (kShoulder * x + kAngle * kLinear) + kToe * kToeNumerator) /
               (x * (kShoulder * x + kLinear) + kToe * kToeDenominator) -
           kToeNumerator / kToeDenominator;
}

float tone_mapped(float light, ToneMap curve) {
    if (curve == ToneMap::None)
        return light;
    if (!(light > 0)) // NaN is dark too
        return 0;
    const float x = std::min(light, 1e6f); // whose square is a float
    switch (curve) {
    case ToneMap::None:
        break;
    case ToneMap::Filmic:
        return std::min(hable(2 * x) / hable(11.2f), 1.0f); // Hable's own exposure of 2
    case ToneMap::Aces:
        return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
    }
    return light;
}

void map_tones(std::span<vec4> pixels, ToneMap curve) {
    for (vec4& pixel : pixels)
        for (int channel = 0; channel < 3; ++channel)
            pixel[channel] = tone_mapped(pixel[channel], curve);
}

} // namespace ovc
