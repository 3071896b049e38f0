// SPDX-License-Identifier: Apache-2.0
// has_sound_textures() checks what evaluating textures relies on, in every scene that was read.
#pragma once

#include "core/scene.h"
#include "core/texture/fractal.h"
#include "core/texture/tiles/tiling.h"

#include <algorithm>
#include <cmath>

namespace ovc {

/// One color takes at most so many steps, and textures lie in each other at most so deep.
inline constexpr double kMaxTextureSteps = 1e6;
inline constexpr uint32_t kMaxTextureDepth = 500;

inline bool is_sound(const Pattern& pattern) {
    const auto finite = [](double x) { return std::isfinite(x); };
    const bool steps =
        std::all_of(pattern.steps.begin(), pattern.steps.end(), [](const TextureStep& step) {
            return step.kind <= TextureStep::Kind::Cubic &&
                   (step.kind < TextureStep::Kind::Cylindrical ||
                    step.kind >= TextureStep::Kind::BoxNet ||
                    (step.rows[0].x >= 0 && step.rows[0].x <= 2)) &&
                   (step.kind != TextureStep::Kind::Turbulence ||
                    (step.rows[1].y >= 0 && step.rows[1].y <= double(kMaxOctaves)));
        });
    const DensityGrid& grid = pattern.grid;
    const uint64_t cells = uint64_t(grid.size[0]) * grid.size[1] * grid.size[2];
    const bool small = std::all_of(grid.size.begin(), grid.size.end(),
                                   [](uint32_t side) { return side <= UINT16_MAX; });
    const bool fractal = pattern.kind != Pattern::Kind::Fractal ||
                         std::all_of(pattern.parameters.begin(), pattern.parameters.end(),
                                     [](double x) { return std::abs(x) <= kMaxFractalIterations; });
    const bool tiled = pattern.kind != Pattern::Kind::Tiling ||
                       (pattern.parameters[0] >= 1 && pattern.parameters[0] <= double(kTilings));
    return steps && small && cells == grid.values.size() && fractal && tiled &&
           pattern.region.triangles.is_sound() && pattern.kind <= Pattern::Kind::Triangular &&
           pattern.wave <= Pattern::Wave::None && pattern.noise >= NoiseKind::Original &&
           pattern.noise <= NoiseKind::Perlin && pattern.octaves.count <= kMaxOctaves &&
           std::all_of(pattern.parameters.begin(), pattern.parameters.end(), finite) &&
           finite(pattern.frequency) && finite(pattern.phase) && finite(pattern.exponent);
}

inline bool is_sound(const ImageTexture& image, size_t pictures) {
    const auto fits = [](Beyond beyond) { return beyond <= Beyond::Nothing; };
    return image.picture < pictures && image.projection <= ImageTexture::Projection::Octahedral &&
           image.channel <= ImageTexture::Channel::CodedMask &&
           image.per <= ImageTexture::Measure::FromAbove && image.window_distance > 0 &&
           fits(image.beyond_s) && fits(image.beyond_t) && image.filter <= TexelFilter::Mipmaps &&
           image.gamma >= 0;
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

/// The most that textures of a scene need, or nothing where one of them is not sound.
struct TextureNeeds {
    std::vector<double> work;
    std::vector<uint32_t> depth;
    bool sound = false;
};

/// mixes: whether a texture's stops name materials instead of textures.
inline TextureNeeds needs_of_textures(const Scene& scene, const std::vector<bool>& mixes) {
    TextureNeeds needs{std::vector<double>(scene.textures.size(), 1),
                       std::vector<uint32_t>(scene.textures.size(), 1)};
    for (size_t t = 0; t < scene.textures.size(); ++t) {
        const Texture& texture = scene.textures[t];
        if (!is_sound(texture, scene.pictures.size()))
            return needs;
        const auto take = [&](uint32_t other) {
            if (other >= t || mixes[other])
                return false;
            needs.work[t] += needs.work[other];
            needs.depth[t] = std::max(needs.depth[t], needs.depth[other] + 1);
            return true;
        };
        for (const TextureStop& stop : texture.stops)
            if (!mixes[t] && stop.texture != kNoTexture && !take(stop.texture))
                return needs;
        const Formula& formula = texture.pattern.formula;
        if (texture.pattern.kind == Pattern::Kind::Function) {
            needs.work[t] += formula_work(formula, t);
            for (const FormulaStep& step : formula.steps)
                if (step.kind >= FormulaStep::Kind::Value && !take(step.index))
                    return needs;
        }
        if (!(needs.work[t] <= kMaxTextureSteps) || needs.depth[t] > kMaxTextureDepth)
            return needs;
    }
    needs.sound = true;
    return needs;
}

/// Returns whether the bump can be evaluated, whose parts are among the first `bumps` of the scene.
inline bool is_sound(const Bump& bump, const Scene& scene, size_t bumps) {
    return bump.kind <= Bump::Kind::Mix && bump.accuracy > 0 &&
           bump.pattern.texture < scene.textures.size() &&
           (bump.kind != Bump::Kind::Mix ||
            (!bump.parts.empty() &&
             bump.parts.size() == scene.textures[bump.pattern.texture].stops.size())) &&
           std::all_of(bump.parts.begin(), bump.parts.end(),
                       [&](uint32_t part) { return part < bumps; });
}

/// Returns whether the scene's bumps are made of earlier ones, and not too many of them.
inline bool has_sound_bumps(const Scene& scene) {
    std::vector<double> work(scene.bumps.size(), 1);
    std::vector<uint32_t> depth(scene.bumps.size(), 1);
    for (size_t b = 0; b < scene.bumps.size(); ++b) {
        if (!is_sound(scene.bumps[b], scene, b))
            return false;
        for (const uint32_t part : scene.bumps[b].parts) {
            work[b] += work[part];
            depth[b] = std::max(depth[b], depth[part] + 1);
        }
        if (!(work[b] <= kMaxTextureSteps) || depth[b] > kMaxTextureDepth)
            return false;
    }
    if (scene.camera && scene.camera->bump &&
        !is_sound(*scene.camera->bump, scene, scene.bumps.size()))
        return false;
    return std::all_of(scene.materials.begin(), scene.materials.end(), [&](const Material& m) {
        return !m.bump || is_sound(*m.bump, scene, scene.bumps.size());
    });
}

/// Returns whether the media's densities are colors.
template <class IsColor>
bool has_sound_densities(const std::vector<Medium>& media, const IsColor& is_color) {
    return std::all_of(media.begin(), media.end(), [&](const Medium& medium) {
        return medium.samples >= 1 && medium.intervals >= 1 && medium.levels <= kMaxMediumLevels &&
               medium.phase <= Medium::Phase::HenyeyGreenstein &&
               std::abs(medium.eccentricity) < 1 &&
               std::all_of(medium.densities.begin(), medium.densities.end(),
                           [&](const PlacedTexture& density) { return is_color(density.texture); });
    });
}

/// Returns whether the material's textures exist and are colors, as is_color(number) says.
template <class IsColor>
bool has_sound_textures(const Scene& scene, const Material& material, const IsColor& is_color) {
    if (material.texture && !is_color(material.texture->texture))
        return false;
    if (material.normal_map && (material.normal_map->kind > NormalMap::Kind::Space ||
                                !is_color(material.normal_map->texture)))
        return false;
    if (material.maps)
        for (const uint32_t map : {material.maps->reflection, material.maps->width,
                                   material.maps->emission, material.maps->metallic})
            if (map != kNone && !is_color(map))
                return false;
    if (!has_sound_densities(material.media, is_color))
        return false;
    return !material.mix || (material.mix->texture < scene.textures.size() &&
                             scene.textures[material.mix->texture].kind == TextureKind::Pattern);
}

/// Returns whether materials are made of earlier ones, which lie at most kMaxTextureDepth deep in
/// each other, and the color of one takes at most kMaxTextureSteps steps. The materials' textures
/// are sound; of_textures: what those need.
inline bool has_sound_coats(const Scene& scene, const TextureNeeds& of_textures) {
    std::vector<double> work(scene.materials.size(), 1);
    std::vector<uint32_t> depth(scene.materials.size(), 1);
    for (size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const auto take = [&](uint32_t other) {
            if (other >= m)
                return false;
            work[m] += work[other];
            depth[m] = std::max(depth[m], depth[other] + 1);
            return true;
        };
        if (material.texture)
            work[m] += of_textures.work[material.texture->texture];
        if (material.mix) {
            work[m] += of_textures.work[material.mix->texture];
            for (const TextureStop& stop : scene.textures[material.mix->texture].stops)
                if (!take(stop.texture))
                    return false;
        }
        if (material.under != kNone && !take(material.under))
            return false;
        if (material.inside != kNone && material.inside >= m)
            return false;
        if (!(work[m] <= kMaxTextureSteps) || depth[m] > kMaxTextureDepth)
            return false;
    }
    return true;
}

/// Returns whether patterns can be evaluated, textures are made of earlier ones and materials of
/// earlier ones, and one color takes at most kMaxTextureSteps steps.
inline bool has_sound_textures(const Scene& scene) {
    std::vector<bool> mixes(scene.textures.size());
    for (const Material& material : scene.materials)
        if (material.mix && material.mix->texture < mixes.size())
            mixes[material.mix->texture] = true;
    const TextureNeeds needs = needs_of_textures(scene, mixes);
    if (!needs.sound || !has_sound_bumps(scene))
        return false;
    const auto is_color = [&](uint32_t texture) {
        return texture < mixes.size() && !mixes[texture];
    };
    for (const Material& material : scene.materials)
        if (!has_sound_textures(scene, material, is_color))
            return false;
    if (!has_sound_coats(scene, needs))
        return false;
    const auto is_plain = [](const TextureStop& stop) { return stop.texture == kNoTexture; };
    for (const Rainbow& rainbow : scene.background.rainbows)
        if (rainbow.colors.empty() || !std::ranges::all_of(rainbow.colors, is_plain))
            return false;
    return std::ranges::all_of(scene.cutouts,
                               [&](const Cutout& cutout) {
                                   return cutout.texture == kNoTexture || is_color(cutout.texture);
                               }) &&
           std::ranges::all_of(
               scene.background.layers,
               [&](const PlacedTexture& layer) { return is_color(layer.texture); }) &&
           std::ranges::all_of(scene.lights,
                               [&](const Light& light) {
                                   return !light.thrown || is_color(light.thrown->texture.texture);
                               }) &&
           has_sound_densities(scene.background.media, is_color);
}

} // namespace ovc
