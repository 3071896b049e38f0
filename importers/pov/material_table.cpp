// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/material_table.h"

#include "core/texture/pattern.h"
#include "importers/pov/parse/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
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

/// Tells the notes of a pattern's stops.
static void tell_of_stops(const PatternPtr& pattern, const Look& look) {
    if (!pattern)
        return;
    for (const MapStop& stop : pattern->stops) {
        tell_all(stop.pigment.notes, look);
        tell_of_stops(stop.pigment.pattern, look);
        if (stop.normal) {
            tell_all(stop.normal->pattern.notes, look);
            tell_of_stops(stop.normal->pattern.pattern, look);
        }
    }
}

uint32_t MaterialTable::number(const Texture& texture, const Color& color, const dmat4& placed,
                               const PlacedInterior& interior, const Texture* inside) {
    for (const Notes* notes : {&texture.notes, &texture.pigment.notes, &texture.surface.notes,
                               &texture.mix.notes, &texture.normal.pattern.notes})
        tell_all(*notes, look_);
    tell_of_stops(texture.pigment.pattern, look_);
    tell_of_stops(texture.normal.pattern.pattern, look_);
    if (interior.interior)
        tell_all(interior.interior->notes, look_);
    ovc::Material material = made(texture, color, placed, interior);
    if (inside) {
        material.inside = number(*inside, inside->pigment.color, placed, interior);
        const ovc::Material& inner = scene_.materials[material.inside];
        material.mirror = std::max(material.mirror, inner.mirror);
        if (material.transmission == 0)
            material.filter = vec3(0); // light that comes from inside may pass, none from outside
        material.transmission = std::max(material.transmission, inner.transmission);
    }
    const auto [first, last] = by_color_.equal_range(color_key(material));
    for (auto known = first; known != last; ++known) {
        const ovc::Material& other = scene_.materials[known->second];
        material.name = other.name; // the name must not make equal materials differ
        if (material == other)
            return known->second;
    }
    const auto number = uint32_t(scene_.materials.size());
    on_uv_.push_back(has_part_on_uv(material));
    material.name = fmt::format("material {}", number + 1);
    by_color_.emplace(color_key(material), number);
    scene_.materials.push_back(std::move(material));
    return number;
}

bool MaterialTable::has_part_on_uv(const ovc::Material& material) const {
    assert(on_uv_.size() == scene_.materials.size());
    if (material.texture && textures_.is_on_uv(material.texture->texture))
        return true;
    if (material.under != kNone && on_uv_[material.under])
        return true;
    if (!material.mix)
        return false;
    const std::vector<TextureStop>& stops = scene_.textures[material.mix->texture].stops;
    return textures_.is_on_uv(material.mix->texture) ||
           std::any_of(stops.begin(), stops.end(),
                       [&](const TextureStop& stop) { return on_uv_[stop.texture]; });
}

/// Puts the steps in front of those of the pigment's pattern.
static void put_in_front(const std::vector<TextureStep>& steps, Pigment& pigment) {
    if (!pigment.pattern)
        return;
    auto map = std::make_shared<PatternMap>(*pigment.pattern);
    std::vector<TextureStep>& own = map->pattern.steps;
    put_in_front(pigment.placed, map->pattern);
    own.insert(own.begin(), steps.begin(), steps.end());
    pigment.placed = dmat4(1);
    pigment.pattern = std::move(map);
}

static void put_in_front(const std::vector<TextureStep>& steps, bool on_uv, Texture& texture) {
    for (Pigment* const part : {&texture.pigment, &texture.mix, &texture.normal.pattern})
        if (part->uv_mapping == on_uv)
            put_in_front(steps, *part);
    if (texture.under) {
        Texture under = *texture.under;
        put_in_front(steps, on_uv, under);
        texture.under = std::make_shared<const Texture>(std::move(under));
    }
}

/// Returns the stops of a map of textures or normals, whose patterns are looked at where the map's
/// warps and turbulence move a point. The warps of a map of pigments move points as it is
/// evaluated.
const std::vector<MapStop>& MaterialTable::moved_stops(const Pigment& mix) {
    const std::vector<TextureStep> steps = steps_of(mix.pattern->pattern);
    if (steps.empty())
        return mix.pattern->stops;
    const auto [known, is_new] = moved_stops_.try_emplace(mix.pattern);
    std::vector<MapStop>& stops = known->second;
    if (!is_new)
        return stops;
    stops = mix.pattern->stops;
    for (MapStop& stop : stops) {
        if (stop.texture) {
            Texture texture = *stop.texture;
            put_in_front(steps, mix.uv_mapping, texture);
            stop.texture = std::make_shared<const Texture>(std::move(texture));
        }
        if (stop.normal) {
            Normal normal = *stop.normal;
            put_in_front(steps, normal.pattern);
            stop.normal = std::make_shared<const Normal>(std::move(normal));
        }
    }
    return stops;
}

/// Makes the material a mix of those of the stops of the texture's map.
void MaterialTable::mix(const Texture& texture, const dmat4& placed, const PlacedInterior& interior,
                        ovc::Material& material) {
    const dmat4 within = placed * texture.mix.placed;
    std::vector<uint32_t> materials;
    for (const MapStop& stop : moved_stops(texture.mix)) {
        Texture part_of_map = *stop.texture;
        if (texture.mix.uv_mapping)
            place(part_of_map, texture.mix.placed);
        materials.push_back(number(part_of_map, part_of_map.pigment.color, within, interior));
        const ovc::Material& part = scene_.materials[materials.back()];
        material.mirror = std::max(material.mirror, part.mirror);
        material.transmission = std::max(material.transmission, part.transmission);
    }
    material.mix = textures_.of_materials(texture.mix, materials, placed);
}

Bump MaterialTable::bump(const Normal& normal, const dmat4& placed) {
    const dmat4 within = placed * normal.pattern.placed;
    const PatternMap& map = *normal.pattern.pattern;
    Bump made{.kind = normal.kind,
              .amount = normal.amount,
              .accuracy = normal.accuracy,
              .keeps_depth = normal.keeps_depth,
              .pattern = textures_.of_pigments(map, within),
              .profile = normal.profile};
    if (map.stops.empty() || !map.stops.front().normal)
        return made;
    made.kind = Bump::Kind::Mix;
    for (const MapStop& stop : moved_stops(normal.pattern)) {
        Bump part; // of no amount
        if (stop.normal && stop.normal->pattern.pattern)
            part = bump(*stop.normal, within);
        else {
            part.amount = 0;
            part.pattern = made.pattern;
        }
        const auto known = std::find(scene_.bumps.begin(), scene_.bumps.end(), part);
        made.parts.push_back(uint32_t(known - scene_.bumps.begin()));
        if (known == scene_.bumps.end())
            scene_.bumps.push_back(std::move(part));
    }
    return made;
}

Medium MaterialTable::medium(const Media& media, const dmat4& placed) {
    tell_all(media.notes, look_);
    Medium made = media.medium;
    for (const Pigment& density : media.densities) {
        tell_all(density.notes, look_);
        tell_of_stops(density.pattern, look_);
        made.densities.push_back(textures_.of_density(density, placed));
    }
    return made;
}

/// Gives the material what an interior says.
void MaterialTable::fill(const PlacedInterior& interior, ovc::Material& material) {
    const Interior& in = *interior.interior;
    if (in.absorption.power >= 0 && in.absorption.distance > 0)
        material.absorption = in.absorption;
    material.caustics = in.caustics;
    for (const Media& media : in.media)
        if (interior.hollow)
            material.media.push_back(medium(media, interior.placed));
}

/// Returns the finish with the amounts that the brightest direction has. Those of a lobe that goes
/// with the cosine to the n-th are (n + 1) / 2 of its albedo, and of one whose half way goes so, (n
/// + 2) / (4 (2 - 2^(-n/2))). Based on: Giesen, "Phong and Blinn-Phong normalization factors".
static Finish with_peaks(const Surface& surface) {
    Finish finish = surface.finish;
    if (surface.diffuse_is_albedo)
        for (float* part : {&finish.diffuse, &finish.diffuse_back})
            *part *= (finish.brilliance + 1) / 2;
    if (surface.phong_is_albedo)
        finish.phong *= (finish.phong_size + 1) / 2;
    if (surface.specular_is_albedo) {
        const float n = 1 / finish.roughness;
        finish.specular *= (n + 2) / (4 * (2 - std::exp2(-n / 2)));
    }
    return finish;
}

/// The largest share of light that a surface adds or lets through.
static constexpr float kMaxShare = 1000;

ovc::Material MaterialTable::made(const Texture& texture, const Color& color, const dmat4& placed,
                                  const PlacedInterior& interior) {
    ovc::Material material;
    const Pigment& pigment = texture.pigment;
    const bool varies = pigment.pattern && !texture.mix.pattern;
    Finish finish = with_peaks(texture.surface);
    finish.emission = texture.surface.emission;
    finish.ambient = texture.surface.ambient * look_.ambient_light + finish.emission;
    finish.irid_wavelengths = look_.irid_wavelengths;
    finish.irid_noise = look_.irid_noise;
    if (interior.double_illuminate)
        finish.diffuse_back = finish.diffuse;
    finish.filter_by_brightest = look_.before_3_7;
    if (!varies) {
        // With a transmit above 1 it is below 0: scenes raise contrasts so. With one below 0, which
        // turns colors round, it is above 1.
        const float share = std::clamp(opacity(color, look_.before_3_7), -kMaxShare, kMaxShare);
        finish.diffuse *= share;
        finish.diffuse_back *= share;
        finish.ambient *= share;
        finish.emission *= share;
    }
    material.color = color.rgb;
    material.mirror =
        std::max(max_component(finish.reflection), max_component(finish.grazing_reflection));
    const float refraction = texture.surface.refraction;
    if (varies) {
        material.transmission = lets_light_through(pigment) ? std::min(refraction, 1.0f) : 0;
        material.texture = textures_.of_pigment(pigment, placed);
    } else {
        const vec3 through = refraction * color.through();
        material.transmission = std::min(max_component(glm::abs(through)), kMaxShare);
        if (material.transmission > 0)
            material.filter = glm::clamp(through / material.transmission, -1.0f, 1.0f);
    }
    const double ior = texture.surface.ior.value_or(interior.interior ? interior.interior->ior : 1);
    material.ior = is_usable_ior(ior) ? ior : 1;
    material.finish = finish;
    material.hollow = look_.has_media && (interior.hollow || interior.is_sheet);
    if (interior.interior)
        fill(interior, material);
    if (texture.normal.pattern.pattern)
        material.bump = bump(texture.normal, placed);
    if (texture.mix.pattern)
        mix(texture, placed, interior, material);
    if (texture.under && material.transmission > 0)
        material.under = number(*texture.under, texture.under->pigment.color, placed, interior);
    return material;
}

} // namespace ovc::pov
