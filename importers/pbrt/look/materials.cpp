// SPDX-License-Identifier: Apache-2.0
// Materials keeps each material once, finds them by name and mixes them.
#include "importers/pbrt/look/materials.h"

#include "importers/file/text.h"
#include "importers/pbrt/look/material_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

static float blend(float a, float b, float share) {
    return a + (b - a) * share;
}

bool is_invisible(const Material& m) {
    return !m.finish && m.transmission == 1 && m.mirror == 0 && m.ior == 1 && m.filter == vec3(1);
}

bool is_emitter(const Material& m) {
    return m.finish && mean(m.finish->ambient) > kAmbient && m.finish->diffuse == 0;
}

/// Equal materials have equal keys, and others hardly ever do.
static std::string key_of(const Material& m) {
    const Finish finish = m.finish.value_or(Finish{});
    return fmt::format("{} {} {} {} {} {} {} {} {} {}", m.name, m.color.x, m.color.y, m.color.z,
                       m.filter.x, m.ior, finish.specular, finish.roughness, finish.reflection.x,
                       finish.ambient.x);
}

bool Materials::is_on_uv(const Material& material) const {
    const MaterialMaps maps = material.maps.value_or(MaterialMaps{});
    return (material.texture && textures_.is_on_uv(material.texture->texture)) ||
           (maps.reflection != kNone && textures_.is_on_uv(maps.reflection)) ||
           (material.normal_map && textures_.is_on_uv(material.normal_map->texture));
}

uint32_t Materials::add(Material material, uint32_t holes) {
    std::string key = key_of(material);
    const auto [first, last] = by_key_.equal_range(key);
    for (auto at = first; at != last; ++at)
        if (all_[at->second] == material && holes_[at->second] == holes)
            return at->second;
    by_key_.emplace(std::move(key), uint32_t(all_.size()));
    holes_.push_back(holes);
    wants_uv_.push_back(is_on_uv(material));
    all_.push_back(std::move(material));
    return uint32_t(all_.size() - 1);
}

Materials::Mapped Materials::mapped(const std::string& type, const Parameters& parameters,
                                    const Place& place) {
    if (type == "mix")
        return {mix(parameters, place)};
    const MaterialContext context{textures_, parameters, diagnostics_, place};
    if (std::optional<Material> material = material_of(type, context))
        return {std::move(*material), holes_of(type, context).value_or(kNoTexture)};
    diagnostics_.missing("material " + type, place,
                         fmt::format("materials {} become matte", ovc::quoted(type)));
    return {make_matte(context)};
}

/// Mixes part by part; the material of the larger share decides what cannot be mixed.
Material Materials::mix(const Parameters& parameters, const Place& place) {
    std::string names[2] = {parameters.text("namedmaterial1"), parameters.text("namedmaterial2")};
    if (const Parameter* p = parameters.find("materials", {Kind::String});
        p && p->strings.size() >= 2)
        std::copy_n(p->strings.begin(), 2, names);
    const Material a = all_[named(names[0], place)], b = all_[named(names[1], place)];
    // v3 counts from the second to the first, v4 the other way round.
    const double amount = textures_.number(parameters, "amount", 0.5);
    const bool v4 = parameters.find("materials") != nullptr;
    const float share = float(std::clamp(v4 ? amount : 1 - amount, 0.0, 1.0));
    const vec3 of_colors = textures_.color(parameters, "amount", vec3(0.5f));
    const vec3 shares = glm::clamp(v4 ? of_colors : vec3(1) - of_colors, vec3(0), vec3(1));
    Material m = share < 0.5f ? a : b;
    m.color = glm::mix(a.color, b.color, shares);
    m.transmission = blend(a.transmission, b.transmission, share);
    m.filter = glm::mix(a.filter, b.filter, shares);
    if (a.finish && b.finish) {
        m.finish->diffuse = blend(a.finish->diffuse, b.finish->diffuse, share);
        m.finish->specular = blend(a.finish->specular, b.finish->specular, share);
        m.finish->reflection = glm::mix(a.finish->reflection, b.finish->reflection, share);
        m.finish->grazing_reflection =
            glm::mix(a.finish->grazing_reflection, b.finish->grazing_reflection, share);
    }
    if (a.optics && b.optics) {
        m.optics->diffuse = glm::mix(a.optics->diffuse, b.optics->diffuse, shares);
        m.optics->through = glm::mix(a.optics->through, b.optics->through, shares);
        m.optics->reflection = (share < 0.5f ? 1 - share : share) * m.optics->reflection;
    }
    return m;
}

uint32_t Materials::make(const std::string& type, const Parameters& parameters,
                         const Place& place) {
    Mapped made = mapped(type, parameters, place);
    made.material.name = type;
    return add(std::move(made.material), made.holes);
}

void Materials::define(const std::string& name, const Parameters& parameters, const Place& place) {
    const std::string type = parameters.text("type", "matte");
    Mapped made = mapped(type, parameters, place);
    made.material.name = name;
    named_.define(name, add(std::move(made.material), made.holes));
}

uint32_t Materials::named(const std::string& name, const Place& place) {
    if (const uint32_t* const found = named_.find(name))
        return *found;
    diagnostics_.missing("named material " + name, place,
                         fmt::format("there is no material {}", ovc::quoted(name)));
    return 0;
}

uint32_t Materials::emitter(uint32_t surface, const vec3& radiance, bool two_sided,
                            const Place& place) {
    Material m;
    assert(surface < all_.size());
    m.optics = all_[surface].optics.value_or(Optics{.diffuse = all_[surface].color});
    m.optics->emission = radiance;
    m.optics->two_sided = two_sided;
    m.name = "emitter";
    m.color = vec3(1);
    m.finish = Finish{};
    m.finish->diffuse = 0;
    m.finish->ambient = radiance;
    return add(std::move(m));
}

} // namespace ovc::pbrt
    if (all_[surface].texture || all_[surface].maps || all_[surface].normal_map)
        diagnostics_.approximate("texture of an emitter", place,
                                 "textures of surfaces that emit light are shown by their mean");
