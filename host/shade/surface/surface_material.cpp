// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/surface_material.h"

#include "core/texture/pattern.h"

namespace ovc {

/// Light of less than this share is not looked for in further coats.
static constexpr float kMinCoat = 1 / 4096.0f;

static void take_color(const Scene& scene, const Material& material, const dvec3& at,
                       SurfacePoint& surface) {
    surface.material = &material;
    const dvec3 smooth = surface.normal;
    if (material.bump)
        surface.normal =
            bumped(scene.textures, scene.bumps, *material.bump, at, smooth, surface.view);
    surface.color = material.color;
    if (material.texture) {
        const PlacedTexture& placed = *material.texture;
        const TransparentColor color =
            color_at(scene.textures, placed.texture, {placed.at(at), smooth, surface.view});
        surface.color = color.rgb;
        if (material.finish) {
            surface.opacity =
                glm::clamp(opacity(color, material.finish->filter_by_brightest), 0.0f, 1.0f);
            surface.through = material.transmission * color.through();
        }
    } else if (material.finish)
        surface.through = material.transmission * material.filter;
}

static vec3 add_mix(const Scene& scene, const PlacedTexture& placed, const dvec3& at,
                    const vec3& weight, const SurfacePoint& bare, std::vector<Coat>& coats);

/// Adds the coats of a material, seen with this weight, and returns the share of light that goes
/// through all of them.
static vec3 add_coats(const Scene& scene, uint32_t number, const dvec3& at, const vec3& weight,
                      const SurfacePoint& bare, std::vector<Coat>& coats) {
    const Material& material = scene.materials[number];
    vec3 through;
    if (material.mix)
        through = add_mix(scene, *material.mix, at, weight, bare, coats);
    else {
        Coat& coat = coats.emplace_back(Coat{bare, weight});
        take_color(scene, material, at, coat.surface);
        through = coat.surface.through;
    }
    if (material.under == kNone || max_component(weight * through) < kMinCoat)
        return through;
    return through * add_coats(scene, material.under, at, weight * through, bare, coats);
}

static vec3 add_mix(const Scene& scene, const PlacedTexture& placed, const dvec3& at,
                    const vec3& weight, const SurfacePoint& bare, std::vector<Coat>& coats) {
    const Texture& mix = scene.textures[placed.texture];
    const PatternPlace place =
        evaluate(scene.textures, mix.pattern, {placed.at(at), bare.normal, bare.view});
    const Between where = between(
        mix.stops.size(), [&](size_t i) { return mix.stops[i].at; }, place.value,
        is_discrete(mix.pattern.kind));
    const float shares[2] = {float(1 - where.share), float(where.share)};
    vec3 through(0);
    for (int i = 0; i < 2; ++i)
        if (shares[i] > 0)
            through +=
                shares[i] * add_coats(scene, mix.stops[i ? where.second : where.first].texture, at,
                                      shares[i] * weight, bare, coats);
    return through;
}

void take_material(const Scene& scene, uint32_t material, const dvec3& at, SurfacePoint& surface) {
    static const Material kPlain;
    if (material >= scene.materials.size()) {
        take_color(scene, kPlain, at, surface);
        return;
    }
    const Material& own = scene.materials[material];
    if (own.under == kNone && !own.mix) {
        take_color(scene, own, at, surface);
        return;
    }
    std::vector<Coat> coats;
    const SurfacePoint bare = surface;
    take_color(scene, own, at, surface);
    surface.through = add_coats(scene, material, at, vec3(1), bare, coats);
    surface.color = vec3(0);
    for (const Coat& coat : coats)
        surface.color += coat.weight * coat.surface.opacity * coat.surface.color;
    surface.opacity = 1;
    surface.coats = std::move(coats);
}

} // namespace ovc
