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

static Checker checker_of(const Pigment& pigment, const dmat4& placed) {
    const dmat4 back = glm::inverse(placed * pigment.placed);
    Checker checker;
    checker.other = pigment.other->rgb;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            checker.to_cubes[size_t(row)][column] = back[column][row];
    return checker;
}

uint32_t MaterialTable::number(const Texture& texture, const Color& color, const dmat4& placed,
                               const Interior* interior) {
    for (const Notes* notes : {&texture.notes, &texture.pigment.notes, &texture.surface.notes})
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

ovc::Material MaterialTable::made(const Texture& texture, const Color& color, const dmat4& placed,
                                  const Interior* interior) const {
    ovc::Material material;
    Finish finish = texture.surface.finish;
    const float opacity = std::clamp(color.opacity(), 0.0f, 1.0f);
    finish.diffuse *= opacity;
    finish.ambient =
        opacity * (texture.surface.ambient * look_.ambient_light + texture.surface.emission);
    material.color = color.rgb;
    material.mirror =
        std::max(max_component(finish.reflection), max_component(finish.grazing_reflection));
    const vec3 through =
        texture.surface.refraction * (color.filter * color.rgb + vec3(color.transmit));
    material.transmission = std::clamp(max_component(through), 0.0f, 1.0f);
    if (material.transmission > 0)
        material.filter = glm::clamp(through / material.transmission, 0.0f, 1.0f);
    const double ior = texture.surface.ior.value_or(interior ? interior->ior : 1);
    material.ior = is_usable_ior(ior) ? ior : 1;
    material.finish = finish;
    if (texture.pigment.other)
        material.checker = checker_of(texture.pigment, placed);
    return material;
}

} // namespace ovc::pov
