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

inline bool is_sound(const ImageTexture& image, size_t pictures) {
    const auto fits = [](Beyond beyond) { return beyond <= Beyond::Nothing; };
    return image.picture < pictures && image.projection <= ImageTexture::Projection::Octahedral &&
           image.channel <= ImageTexture::Channel::Mask && fits(image.beyond_s) &&
           fits(image.beyond_t) && image.filter <= TexelFilter::Mipmaps && image.gamma >= 0;
}

/// Returns whether a texture has the parts that its kind asks for.
inline bool is_sound(const Texture& texture, size_t pictures) {
    if (!is_sound(texture.pattern) || texture.kind > TextureKind::Mix)
        return false;
    if (texture.image && !is_sound(*texture.image, pictures))
        return false;
    if (texture.kind == TextureKind::Image)
        return texture.image.has_value();
    return texture.stops.size() >= (texture.kind == TextureKind::Mix ? 3u : 1u);
}

/// The most patterns that one color may take, and materials that one surface may be made of.
inline constexpr double kMaxTextureSteps = 1e5;

/// Returns whether textures are made of earlier ones, whose stops are materials where `mixes` says
/// so, and one color takes at most kMaxTextureSteps patterns.
inline bool are_sound_trees(const Scene& scene, const std::vector<bool>& mixes) {
    std::vector<double> work(scene.textures.size(), 1);
    for (size_t t = 0; t < scene.textures.size(); ++t) {
        const Texture& texture = scene.textures[t];
        if (!is_sound(texture, scene.pictures.size()))
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
    return true;
}

/// Returns whether the material's textures exist and are colors, as is_color(number) says.
template <class IsColor>
bool has_sound_textures(const Scene& scene, const Material& material, const IsColor& is_color) {
    if (material.texture && !is_color(material.texture->texture))
        return false;
    if (material.bump &&
        (material.bump->kind > Bump::Kind::Wrinkles || !(material.bump->accuracy > 0) ||
         material.bump->pattern.texture >= scene.textures.size()))
        return false;
    if (material.normal_map && (material.normal_map->kind > NormalMap::Kind::Tangent ||
                                !is_color(material.normal_map->texture)))
        return false;
    if (material.maps)
        for (const uint32_t map : {material.maps->reflection, material.maps->width,
                                   material.maps->emission, material.maps->metallic})
            if (map != kNone && !is_color(map))
                return false;
    return !material.mix || (material.mix->texture < scene.textures.size() &&
                             scene.textures[material.mix->texture].kind == TextureKind::Pattern);
}

/// Returns whether patterns can be evaluated, textures are made of earlier ones and materials of
/// earlier ones, and one color takes at most kMaxTextureSteps patterns.
inline bool has_sound_textures(const Scene& scene) {
    std::vector<bool> mixes(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.mix && material.mix->texture < mixes.size())
            mixes[material.mix->texture] = true;
    if (!are_sound_trees(scene, mixes))
        return false;
    const auto is_color = [&](uint32_t texture) {
        return texture < mixes.size() && !mixes[texture];
    };
    std::vector<double> layers(scene.materials.size(), 1);
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        if (!has_sound_textures(scene, material, is_color))
            return false;
        for (size_t i = 0; material.mix && i < scene.textures[material.mix->texture].stops.size();
             ++i) {
            const uint32_t part = scene.textures[material.mix->texture].stops[i].texture;
            if (part >= m)
                return false;
            layers[m] += layers[part];
        }
        if (material.under != kNone) {
            if (material.under >= m)
                return false;
            layers[m] *= 1 + layers[material.under];
        }
        if (!(layers[m] <= kMaxTextureSteps))
            return false;
    }
    return std::ranges::all_of(scene.cutouts,
                               [&](const Cutout& cutout) {
                                   return cutout.texture == kNoTexture || is_color(cutout.texture);
                               }) &&
           std::ranges::all_of(scene.background.layers,
                               [&](const PlacedTexture& layer) { return is_color(layer.texture); });
}

} // namespace ovc
