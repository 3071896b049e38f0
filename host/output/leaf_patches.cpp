// SPDX-License-Identifier: Apache-2.0
// Turns numbers of leaves into colors, and colors into a PNG file.
#include "host/output/leaf_patches.h"

#include "host/diff/channels.h"
#include "host/terminal/version.h"
#include "importers/png.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace ovc {

namespace {

constexpr float kNothing = 0.55f; // readable on light ground and on dark
constexpr uint32_t kNoLeaf = 0xffffffff;

/// Returns the color of a hue from 0 to 1, with little white in it.
PatchColor from_hue(double hue) {
    const auto channel = [&](double shift) {
        const double x = std::abs(std::fmod(hue + shift, 1.0) * 6 - 3) - 1;
        return float(0.25 + 0.7 * std::clamp(x, 0.0, 1.0));
    };
    return {channel(0), channel(2.0 / 3), channel(1.0 / 3)};
}

/// Returns Lambert's cosine to a light above and to the side, with a minimum so that nothing is
/// dark.
float shade(float x, float y, float z) {
    return 0.45f + 0.55f * std::abs(0.36f * x + 0.8f * y + 0.48f * z);
}

float value_at(const Layer& layer, size_t i) {
    return std::bit_cast<float>(layer.values[i]);
}

uint16_t sample(float value) {
    return uint16_t(std::lround(65535 * std::clamp(value, 0.0f, 1.0f)));
}

} // namespace

PatchColor patch_color(uint32_t leaf) {
    constexpr double kGolden = 0.6180339887498949; // its multiples modulo 1 stay far apart
    return from_hue(std::fmod(kGolden * leaf, 1.0));
}

Result<std::string> leaf_patches(const std::filesystem::path& exr) {
    const Result<Channels> channels = read_channels(exr);
    if (!channels)
        return channels.error();
    const Layer *leaf = channels->find("leaf"), *x = channels->find("normal.X"),
                *y = channels->find("normal.Y"), *z = channels->find("normal.Z");
    if (!leaf || !x || !y || !z)
        return Error{fmt::format("{} has no layers leaf and normal", exr.string())};
    std::vector<uint16_t> samples;
    samples.reserve(3 * channels->size());
    for (size_t i = 0; i < channels->size(); ++i) {
        PatchColor color{kNothing, kNothing, kNothing};
        float light = 1;
        if (leaf->values[i] != kNoLeaf) {
            color = patch_color(leaf->values[i]);
            light = shade(value_at(*x, i), value_at(*y, i), value_at(*z, i));
        }
        for (const float channel : {color.red, color.green, color.blue})
            samples.push_back(sample(light * channel));
    }
    return write_png({channels->width, channels->height, 8, samples}, "overcast " + version_text());
}

} // namespace ovc
