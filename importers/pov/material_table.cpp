// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/material_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace ovc::pov {

void tell_all(const Notes& notes, const Look& look) {
    for (const auto& note : notes)
        if (look.tell)
            look.tell(*note);
}

/// Returns a hash of the color, in which materials usually differ.
static size_t color_key(const ovc::Material& m) {
    size_t key = 0;
    for (int i = 0; i < 3; ++i)
        key = 31 * key + std::hash<float>()(m.color[i]);
    return key;
}

uint32_t MaterialTable::number(const Texture& texture, const Color& color, const dmat4& placed,
                               const Interior* interior) {
    for (const Notes* notes : {&texture.notes, &texture.pigment.notes, &texture.surface.notes,
                               &texture.mix.notes, &texture.normal.pattern.notes})
        tell_all(*notes, look_);
    if (interior)
        tell_all(interior->notes, look_);
    ovc::Material material = made(texture, color, placed, interior);
    const auto [first, last] = by_color_.equal_range(color_key(material));
    for (auto known = first; known != last; ++known) {
        const ovc::Material& other = scene_.materials[known->second];
        material.name = other.name; // the name must not make equal materials differ
        if (material == other)
            return known->second;
    }
    const auto number = uint32_t(scene_.materials.size());
    material.name = fmt::format("material {}", number + 1);
    by_color_.emplace(color_key(material), number);
    scene_.materials.push_back(std::move(material));
    return number;
}

/// Makes the material a mix of those of the stops of the texture's map.
void MaterialTable::mix(const Texture& texture, const dmat4& placed, const Interior* interior,
                        ovc::Material& material) {
    const PatternMap& map = *texture.mix.pattern;
    const dmat4 within = placed * texture.mix.placed;
    std::vector<uint32_t> materials;
    for (const MapStop& stop : map.stops) {
        materials.push_back(number(*stop.texture, stop.texture->pigment.color, within, interior));
        const ovc::Material& part = scene_.materials[materials.back()];
        material.mirror = std::max(material.mirror, part.mirror);
        material.transmission = std::max(material.transmission, part.transmission);
    }
    material.mix = textures_.of_materials(map, materials, within);
}

ovc::Material MaterialTable::made(const Texture& texture, const Color& color, const dmat4& placed,
                                  const Interior* interior) {
    ovc::Material material;
    const Pigment& pigment = texture.pigment;
    const bool varies = pigment.pattern && !texture.mix.pattern;
    Finish finish = texture.surface.finish;
    finish.ambient = texture.surface.ambient * look_.ambient_light + texture.surface.emission;
    if (!varies) {
        const float opacity = std::clamp(color.opacity(), 0.0f, 1.0f);
        finish.diffuse *= opacity;
        finish.ambient *= opacity;
    }
    material.color = color.rgb;
    material.mirror =
        std::max(max_component(finish.reflection), max_component(finish.grazing_reflection));
    const float refraction = texture.surface.refraction;
    if (varies) {
        material.transmission = lets_light_through(pigment) ? std::min(refraction, 1.0f) : 0;
        material.texture = textures_.of_pigments(*pigment.pattern, placed * pigment.placed);
    } else {
        const vec3 through = refraction * color.through();
        material.transmission = std::clamp(max_component(through), 0.0f, 1.0f);
        if (material.transmission > 0)
            material.filter = glm::clamp(through / material.transmission, 0.0f, 1.0f);
    }
    const double ior = texture.surface.ior.value_or(interior ? interior->ior : 1);
    material.ior = is_usable_ior(ior) ? ior : 1;
    material.finish = finish;
    if (const Normal& normal = texture.normal; normal.pattern.pattern)
        material.bump =
            Bump{normal.kind, normal.amount, normal.accuracy,
                 textures_.of_pigments(*normal.pattern.pattern, placed * normal.pattern.placed)};
    if (texture.mix.pattern)
        mix(texture, placed, interior, material);
    if (texture.under && material.transmission > 0)
        material.under = number(*texture.under, texture.under->pigment.color, placed, interior);
    return material;
}

} // namespace ovc::pov
