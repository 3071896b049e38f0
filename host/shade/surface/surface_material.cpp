// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/surface_material.h"

#include "core/texture/pattern.h"

#include <algorithm>

namespace ovc {

/// Light of less than this share is not looked for in further coats.
static constexpr float kMinCoat = 1 / 4096.0f;

/// The normal stays on the side that is seen.
static void tilt_by_map(const Scene& scene, const NormalMap& map, const TexturePoint& point,
                        SurfacePoint& surface) {
    const double side = surface.entering ? 1 : -1;
    const dvec3 normal = side * tilted(scene.textures, map, point, side * surface.normal);
    if (glm::dot(normal, surface.geometric_normal) > 0)
        surface.normal = normal;
}

static void take_maps(const Scene& scene, const MaterialMaps& maps, const TexturePoint& point,
                      MapValues& values) {
    const auto color = [&](uint32_t map) {
        return map == kNone ? vec3(1) : glm::max(color_at(scene.textures, map, point).rgb, vec3(0));
    };
    const auto mean = [&](uint32_t map) {
        const vec3 c = color(map);
        return (c.x + c.y + c.z) / 3;
    };
    values.reflection = color(maps.reflection);
    values.emission = color(maps.emission);
    values.width = mean(maps.width);
    if (maps.metallic != kNone)
        values.metal = std::min(mean(maps.metallic), 1.0f);
}

/// The share that a surface reflects head on where it is no metal: that of an index of 1.5.
static constexpr float kPlainReflection = 0.04f;

Optics optics_at(const SurfacePoint& surface) {
    Optics optics = *surface.material->optics;
    if (const Material& material = *surface.material; material.texture)
        optics.diffuse = (material.finish ? 1 : 1 - material.transmission) * surface.color;
    if (const float metal = surface.maps.metal; metal >= 0) {
        optics.boundary = Optics::Boundary::Metal;
        optics.reflection = glm::mix(vec3(kPlainReflection), surface.color, metal);
        optics.diffuse = (1 - metal) * surface.color;
    }
    optics.reflection = glm::min(optics.reflection * surface.maps.reflection, vec3(1));
    optics.width *= surface.maps.width;
    optics.emission *= surface.maps.emission;
    return optics;
}

static void take_color(const Scene& scene, const Material& material, const TexturePoint& point,
                       SurfacePoint& surface) {
    surface.material = &material;
    if (material.bump)
        surface.normal =
            bumped(scene.textures, scene.bumps, *material.bump, point.at, point.normal, point.view);
    if (material.normal_map)
        tilt_by_map(scene, *material.normal_map, point, surface);
    surface.color = material.color;
    if (material.texture) {
        const PlacedTexture& placed = *material.texture;
        TexturePoint tilted = point;
        if (material.bump) // POV-Ray's slopes and angles of incidence are those of tilted normals
            tilted.normal = surface.normal;
        const TransparentColor color = color_at(scene.textures, placed, tilted);
        // A picture that is scaled or inverted may say that more light is sent on than arrives.
        surface.color = material.optics ? glm::clamp(color.rgb, vec3(0), vec3(1)) : color.rgb;
        if (material.finish) {
            surface.opacity =
                glm::clamp(opacity(color, material.finish->filter_by_brightest), 0.0f, 1.0f);
            surface.through = material.transmission * color.through();
        }
    } else if (material.finish)
        surface.through = material.transmission * material.filter;
    if (material.maps)
        take_maps(scene, *material.maps, point, surface.maps);
}

static vec3 add_mix(const Scene& scene, const PlacedTexture& placed, const TexturePoint& point,
                    const vec3& weight, float share_of_mixes, const SurfacePoint& bare,
                    std::vector<Coat>& coats);

/// Adds the coats of a material, seen with this weight, and returns the share of light that goes
/// through all of them.
static vec3 add_coats(const Scene& scene, uint32_t number, const TexturePoint& point,
                      const vec3& weight, float share_of_mixes, const SurfacePoint& bare,
                      std::vector<Coat>& coats) {
    const Material& material = scene.materials[number];
    vec3 through;
    if (material.mix)
        through = add_mix(scene, *material.mix, point, weight, share_of_mixes, bare, coats);
    else {
        Coat& coat = coats.emplace_back(Coat{bare, weight, share_of_mixes});
        take_color(scene, material, point, coat.surface);
        through = coat.surface.through;
    }
    if (material.under == kNone || max_component(weight * through) < kMinCoat)
        return through;
    return through *
           add_coats(scene, material.under, point, weight * through, share_of_mixes, bare, coats);
}

static vec3 add_mix(const Scene& scene, const PlacedTexture& placed, const TexturePoint& point,
                    const vec3& weight, float share_of_mixes, const SurfacePoint& bare,
                    std::vector<Coat>& coats) {
    const Texture& mix = scene.textures[placed.texture];
    vec3 through(0);
    const auto add_stop = [&](const TextureStop& stop, double share) {
        if (share > 0)
            through += float(share) * add_coats(scene, stop.texture, point, float(share) * weight,
                                                float(share) * share_of_mixes, bare, coats);
    };
    if (mix.pattern.kind == Pattern::Kind::Average) {
        for_each_averaged(mix.stops, add_stop);
        return through;
    }
    const PatternPlace place =
        evaluate(scene.textures, mix.pattern, mix.on_uv ? moved_to_uv(point) : placed.at(point));
    const Between where = stops_at(mix, place.value);
    add_stop(mix.stops[where.first], 1 - where.share);
    add_stop(mix.stops[where.second], where.share);
    return through;
}

void take_material(const Scene& scene, uint32_t material, const TexturePoint& point,
                   SurfacePoint& surface) {
    static const Material kPlain;
    if (material >= scene.materials.size()) {
        take_color(scene, kPlain, point, surface);
        return;
    }
    const Material& own = scene.materials[material];
    if (own.under == kNone && !own.mix) {
        take_color(scene, own, point, surface);
        return;
    }
    std::vector<Coat> coats;
    const SurfacePoint bare = surface;
    take_color(scene, own, point, surface);
    surface.through = add_coats(scene, material, point, vec3(1), 1, bare, coats);
    surface.color = vec3(0);
    for (const Coat& coat : coats)
        surface.color += coat.weight * coat.surface.opacity * coat.surface.color;
    surface.opacity = 1;
    surface.coats = std::move(coats);
}

} // namespace ovc
