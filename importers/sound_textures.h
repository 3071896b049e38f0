// SPDX-License-Identifier: Apache-2.0
// has_sound_textures() checks what evaluating textures relies on, in every scene that was read.
#pragma once

#include "core/scene.h"

#include <algorithm>
#include <cmath>

namespace ovc {

inline bool is_sound(const Pattern& pattern) {
    const auto finite = [](double x) { return std::isfinite(x); };
    const bool steps =
        std::all_of(pattern.steps.begin(), pattern.steps.end(), [](const TextureStep& step) {
            return step.kind <= TextureStep::Kind::Repeat &&
                   (step.kind != TextureStep::Kind::Turbulence ||
                    (step.rows[1].y >= 0 && step.rows[1].y <= kMaxOctaves));
        });
    return steps && pattern.kind <= Pattern::Kind::Hexagon &&
           pattern.wave <= Pattern::Wave::Power && pattern.noise >= NoiseKind::Original &&
           pattern.noise <= NoiseKind::Corrected && pattern.octaves.count <= kMaxOctaves &&
           std::all_of(pattern.parameters.begin(), pattern.parameters.end(), finite) &&
           finite(pattern.frequency) && finite(pattern.phase) && finite(pattern.exponent);
}

/// Returns whether patterns can be evaluated, textures are made of earlier ones and materials of
/// earlier ones, and one color takes at most kMaxTextureSteps patterns.
inline bool has_sound_textures(const Scene& scene) {
    constexpr double kMaxTextureSteps = 1e5;
    std::vector<bool> mixes(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.mix && material.mix->texture < mixes.size())
            mixes[material.mix->texture] = true;
    std::vector<double> work(scene.textures.size(), 1);
    for (size_t t = 0; t < scene.textures.size(); ++t) {
        const Texture& texture = scene.textures[t];
        if (texture.stops.empty() || !is_sound(texture.pattern))
            return false;
        for (const TextureStop& stop : texture.stops) {
            if (mixes[t] || stop.texture == kNoTexture)
                continue;
            if (stop.texture >= t || mixes[stop.texture])
                return false;
            work[t] += work[stop.texture];
        }
        if (!(work[t] <= kMaxTextureSteps))
            return false;
    }
    const auto is_color = [&](const PlacedTexture& placed) {
        return placed.texture < mixes.size() && !mixes[placed.texture];
    };
    std::vector<double> layers(scene.materials.size(), 1);
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (material.texture && !is_color(*material.texture))
            return false;
        if (material.bump &&
            (material.bump->kind > Bump::Kind::Wrinkles || !(material.bump->accuracy > 0) ||
             material.bump->pattern.texture >= scene.textures.size()))
            return false;
        if (material.mix) {
            if (material.mix->texture >= mixes.size())
                return false;
            for (const TextureStop& stop : scene.textures[material.mix->texture].stops) {
                if (stop.texture >= m)
                    return false;
                layers[m] += layers[stop.texture];
            }
        }
        if (material.under != kNone) {
            if (material.under >= m)
                return false;
            layers[m] *= 1 + layers[material.under];
        }
        if (!(layers[m] <= kMaxTextureSteps))
            return false;
    }
    const std::vector<PlacedTexture>& sky = scene.background.layers;
    return std::all_of(sky.begin(), sky.end(), is_color);
}

} // namespace ovc
