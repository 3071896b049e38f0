// SPDX-License-Identifier: Apache-2.0
// Exposure scales a picture's light, and tone mapping fits it into the range of a display.
#pragma once

#include "core/file/pixel_source.h"

#include <cstdint>
#include <optional>
#include <span>

namespace ovc {

/// The exposure of a picture: a number of stops, each of which doubles its light, or what suits it.
struct Exposure {
    bool is_automatic = false;
    double stops = 0;
};

enum class ToneMap : uint8_t {
    None,   // light above 1 is cut off
    Filmic, // Hable 2010, "Uncharted 2: HDR Lighting": the curve of film, with white at 11.2
    Aces    // Narkowicz 2016, "ACES Filmic Tone Mapping Curve": a fit of the Academy's curve
};

/// Returns the stops that bring the log-average of the image's luminances to 0.18, a middle grey;
/// 0 where nothing in it is bright. Pixels that are black or not done do not count.
/// Source: Reinhard et al. 2002, "Photographic Tone Reproduction for Digital Images", formula 1.
double automatic_stops(const PixelSource& image);

/// Converts the light of a scene of that gamma (Scene::gamma) to linear light.
void to_linear(std::span<vec4> pixels, double gamma);

/// Doubles the light of pixels so many times.
void expose(std::span<vec4> pixels, double stops);

/// Returns light, at least 0, as a curve maps it to a display's linear light, at most 1 for Filmic
/// and Aces.
float tone_mapped(float light, ToneMap curve);

/// Maps each channel by itself.
void map_tones(std::span<vec4> pixels, ToneMap curve);

} // namespace ovc
