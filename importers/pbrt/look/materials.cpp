// SPDX-License-Identifier: Apache-2.0
// Materials keeps each material once, finds them by name and mixes them.
#include "importers/pbrt/look/materials.h"

#include "core/fresnel.h"
#include "importers/file/text.h"
#include "importers/pbrt/look/material_families.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

bool is_invisible(const Material& m) {
    return !m.finish && m.transmission == 1 && m.mirror == 0 && m.ior == 1 && m.filter == vec3(1);
}

bool is_clear(const Material& m) {
    return m.optics && m.optics->through != vec3(0) &&
           m.optics->boundary == Optics::Boundary::Dielectric;
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
    if (material.mix &&
        std::ranges::any_of(textures_.stops_of(material.mix->texture),
                            [&](const TextureStop& stop) { return wants_uv_[stop.texture]; }))
        return true;
    return (material.texture && textures_.is_on_uv(material.texture->texture)) ||
           (maps.reflection != kNone && textures_.is_on_uv(maps.reflection)) ||
           (material.normal_map && textures_.is_on_uv(material.normal_map->texture));
}

uint32_t Materials::add(Mapped made) {
    auto& [material, holes, mixes] = made;
    std::string key = key_of(material);
    const auto [first, last] = by_key_.equal_range(key);
    for (auto at = first; at != last; ++at)
        if (all_[at->second] == material && holes_[at->second] == holes)
            return at->second;
    by_key_.emplace(std::move(key), uint32_t(all_.size()));
    holes_.push_back(holes);
    mixes_.push_back(mixes);
    wants_uv_.push_back(is_on_uv(material));
    all_.push_back(std::move(material));
    return uint32_t(all_.size() - 1);
}

Materials::Mapped Materials::mapped(const std::string& type, const Parameters& parameters,
                                    const Place& place) {
    if (type == "mix")
        return mix(parameters, place);
    const MaterialContext context{textures_, parameters, diagnostics_, place};
    if (std::optional<Material> material = material_of(type, context))
        return {std::move(*material), holes_of(type, context).value_or(kNoTexture)};
    diagnostics_.missing("material " + type, place,
                         fmt::format("materials {} become matte", ovc::quoted(type)));
    return {make_matte(context)};
}

/// Returns the share that a boundary reflects of light from all directions.
static vec3 mean_reflection(const Optics& optics) {
    switch (optics.boundary) {
    case Optics::Boundary::None:
        return vec3(0);
    case Optics::Boundary::Mirror:
        return optics.reflection;
    case Optics::Boundary::Metal:
        return glm::mix(optics.reflection, vec3(1), 1 / 21.0f);
    default:
        return optics.reflection * float(fresnel_mean(optics.ior));
    }
}

static bool has_boundary(const Material& m) {
    return m.optics && m.optics->boundary != Optics::Boundary::None;
}

static bool is_one_boundary(const Optics& a, const Optics& b) {
    return a.boundary == b.boundary && a.ior == b.ior && a.width == b.width &&
           a.internal_reflection == b.internal_reflection;
}

/// Returns whether a mix of the two is no one surface: each has its own share of the hits.
static bool are_beside(const Material& a, const Material& b) {
    return a.optics && b.optics &&
           (a.mix || b.mix ||
            (has_boundary(a) && has_boundary(b) && !is_one_boundary(*a.optics, *b.optics)));
}

namespace {

/// Two materials of which the second has the share `amount`.
struct Mixture {
    const Material &a, &b;
    vec3 amount;
    bool keeps_b; // what cannot be mixed is that of b

    template <class T>
    T of(const T& in_a, const T& in_b) const {
        return glm::mix(in_a, in_b, T(amount));
    }
    float of(float in_a, float in_b) const { return in_a + (in_b - in_a) * mean(amount); }
};

/// The factors of the grounds of two materials that lie below one boundary now.
struct Grounds {
    vec3 a{1}, b{1};
};

} // namespace

/// The colors of two finishes count by the light that they scatter.
static void mix_finishes(const Mixture& mix, Material& m) {
    const Finish invisible{.diffuse = 0};
    const Finish a = mix.a.finish.value_or(invisible), b = mix.b.finish.value_or(invisible);
    m.finish = m.finish.value_or(invisible);
    m.finish->diffuse = mix.of(a.diffuse, b.diffuse);
    m.finish->specular = mix.of(a.specular, b.specular);
    m.finish->reflection = mix.of(a.reflection, b.reflection);
    m.finish->grazing_reflection = mix.of(a.grazing_reflection, b.grazing_reflection);
    if (m.finish->diffuse > 0)
        m.color = mix.of(mix.a.color * a.diffuse, mix.b.color * b.diffuse) / m.finish->diffuse;
}

/// Each ground keeps the light that comes out of its own boundary.
static Grounds mix_optics(const Mixture& mix, Optics& m) {
    const Optics &a = *mix.a.optics, &b = *mix.b.optics;
    const bool is_one = is_one_boundary(a, b);
    m.through = mix.of(a.through, b.through);
    m.diffuse_behind = mix.of(a.diffuse_behind, b.diffuse_behind);
    m.reflection = is_one ? mix.of(a.reflection, b.reflection)
                          : (mix.keeps_b ? mix.amount : vec3(1) - mix.amount) * m.reflection;
    m.internal_reflection = is_one && a.internal_reflection;
    // Of a clear surface, whose ground lies beside the glass, no light is lost to the boundary.
    const vec3 below =
        m.through == vec3(0) ? glm::max(vec3(1) - mean_reflection(m), vec3(1e-6f)) : vec3(1);
    const auto factor = [&](const Optics& of) {
        const vec3 outside =
            of.internal_reflection && !is_one ? share_from_below(of.diffuse, of.ior) : vec3(1);
        return outside * (vec3(1) - mean_reflection(of)) / below;
    };
    const Grounds grounds{factor(a), factor(b)};
    m.diffuse = glm::min(mix.of(grounds.a * a.diffuse, grounds.b * b.diffuse), vec3(1));
    return grounds;
}

Materials::Mapped Materials::mix(const Parameters& parameters, const Place& place) {
    std::string names[2] = {parameters.text("namedmaterial1"), parameters.text("namedmaterial2")};
    const Parameter* const v4 = parameters.find("materials", {Kind::String});
    if (v4 && v4->strings.size() >= 2)
        std::copy_n(v4->strings.begin(), 2, names);
    else // v3's amount is that of the first
        std::swap(names[0], names[1]);
    const uint32_t a = named(names[0], place), b = named(names[1], place);
    const uint32_t mixes = 1 + mixes_[a] + mixes_[b];
    if (mixes > kMaxCombined)
        diagnostics_.fail(place, fmt::format("found a mix of more than {} others", kMaxCombined));
    Material material = mixed(all_[a], all_[b], parameters);
    if (are_beside(all_[a], all_[b])) {
        if (textures_.is_pattern(parameters, "amount"))
            diagnostics_.approximate("mix of boundaries", place,
                                     "two materials that shine are mixed in the same proportion "
                                     "everywhere");
        const float amount = mean(amount_of(parameters));
        material.mix = placed_in_world(
            textures_.average({{double(1 - amount), {}, a}, {double(amount), {}, b}}));
    }
    return {material, mixed_holes(holes_[a], holes_[b], parameters, place), mixes};
}

/// Each part has its own holes in pbrt, by chance; here they lie in both alike.
uint32_t Materials::mixed_holes(uint32_t a, uint32_t b, const Parameters& parameters,
                                const Place& place) {
    if (a == b)
        return a;
    diagnostics_.approximate("mix of holes", place,
                             "of a mix of two materials with different holes, both are seen alike "
                             "where there is something");
    const auto opacity = [](uint32_t holes) { return TextureStop{0, {vec3(1)}, holes}; };
    const auto share = textures_.texture(parameters, "amount");
    const TextureStop amount{0, {amount_of(parameters)}, share.value_or(kNoTexture)};
    return textures_.mix(opacity(a), opacity(b), amount);
}

vec3 Materials::amount_of(const Parameters& parameters) const {
    return glm::clamp(textures_.color(parameters, "amount", vec3(0.5f)), vec3(0), vec3(1));
}

/// Mixes part by part. What cannot be mixed is that of the only material that has a boundary, or
/// else of the larger share.
Material Materials::mixed(const Material& a, const Material& b, const Parameters& parameters) {
    const vec3 amount = amount_of(parameters);
    const Mixture mixture{
        a, b, amount, has_boundary(a) != has_boundary(b) ? has_boundary(b) : mean(amount) >= 0.5f};
    Material m = mixture.keeps_b ? b : a;
    m.mirror = std::max(a.mirror, b.mirror);
    m.transmission = mixture.of(a.transmission, b.transmission);
    m.filter = mixture.of(a.filter, b.filter);
    if (a.finish || b.finish)
        mix_finishes(mixture, m);
    if (!a.optics || !b.optics)
        return m;
    const Grounds grounds = mix_optics(mixture, *m.optics);
    const auto share = textures_.texture(parameters, "amount");
    if (!a.texture && !b.texture && !share)
        return m;
    const auto stop = [&](const Material& of, const vec3& factor) {
        return of.texture ? TextureStop{0, {}, textures_.product(of.texture->texture, factor)}
                          : TextureStop{0, {factor * of.optics->diffuse}, kNoTexture};
    };
    m.texture = placed_in_world(
        textures_.mix(stop(a, grounds.a), stop(b, grounds.b),
                      share ? TextureStop{0, {}, *share} : TextureStop{0, {amount}, kNoTexture}));
    return m;
}

uint32_t Materials::make(const std::string& type, const Parameters& parameters,
                         const Place& place) {
    Mapped made = mapped(type, parameters, place);
    made.material.name = type;
    return add(std::move(made));
}

void Materials::define(const std::string& name, const Parameters& parameters, const Place& place) {
    const std::string type = parameters.text("type", "matte");
    Mapped made = mapped(type, parameters, place);
    made.material.name = name;
    named_.define(name, add(std::move(made)));
}

uint32_t Materials::named(const std::string& name, const Place& place) {
    if (const uint32_t* const found = named_.find(name))
        return *found;
    diagnostics_.missing("named material " + name, place,
                         fmt::format("there is no material {}", ovc::quoted(name)));
    return 0;
}

uint32_t Materials::filled(uint32_t glass, const vec3& absorbed) {
    Material m = all_[glass];
    const float strongest = max_component(absorbed);
    assert(strongest > 0);
    m.absorption = Absorption{1 / strongest, 1000, vec3(1) - absorbed / strongest};
    return add({std::move(m), holes_[glass], mixes_[glass]});
}

/// A picture multiplies the emission of optics alone, which shows without a finish too.
uint32_t Materials::emitter(uint32_t surface, const Emission& emission, const vec3& radiance,
                            const Place& place) {
    Material m;
    assert(surface < all_.size());
    if (all_[surface].texture || all_[surface].maps || all_[surface].normal_map)
        diagnostics_.approximate("texture of an emitter", place,
                                 "textures of surfaces that emit light are shown by their mean");
    m.optics = all_[surface].optics.value_or(Optics{.diffuse = all_[surface].color});
    m.optics->emission = radiance;
    m.optics->two_sided = emission.two_sided;
    m.name = "emitter";
    if (emission.picture) {
        m.color = vec3(0);
        m.maps = MaterialMaps{.emission = *emission.picture};
        return add({std::move(m)});
    }
    m.color = vec3(1);
    m.finish = Finish{};
    m.finish->diffuse = 0;
    m.finish->ambient = radiance;
    return add({std::move(m)});
}

} // namespace ovc::pbrt
