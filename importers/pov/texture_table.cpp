// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/texture_table.h"

#include "core/texture/pattern.h"
#include "importers/file/picture_path.h"
#include "importers/pov/material_table.h"
#include "importers/pov/pictures/map_picture.h"
#include "importers/pov/values/transform.h"

#include <algorithm>
#include <functional>

namespace ovc::pov {

static PlacedTexture placed_texture(uint32_t number, const dmat4& placed) {
    return {number, rows_of(glm::inverse(placed))};
}

void put_in_front(const dmat4& placed, Pattern& pattern) {
    if (placed == dmat4(1))
        return;
    TextureStep step;
    step.rows = placed_texture(0, placed).to_texture;
    pattern.steps.insert(pattern.steps.begin(), step);
}

/// Returns a hash of what usually differs.
static size_t key_of(const ovc::Texture& texture) {
    size_t key = size_t(texture.pattern.kind) + 31 * texture.stops.size();
    const auto add = [&](double x) { key = 31 * key + std::hash<double>()(x); };
    for (const TextureStop& stop : texture.stops)
        for (int i = 0; i < 3; ++i)
            add(double(stop.color.rgb[i]));
    add(texture.pattern.turbulence.x);
    add(texture.pattern.frequency);
    add(texture.image ? texture.image->picture : 0);
    return key;
}

/// Makes an image of the picture, which it looks at.
static void show(const ImageMap& map, ovc::Texture& texture) {
    texture.kind = TextureKind::Image;
    texture.image = map.image;
    texture.image->lookup = map.picture.get();
}

/// Names the picture of an image in the scene, in the place of looking at it.
static void name_picture(Scene& scene, ImageTexture& image) {
    // Nothing else is looked at while a scene is read.
    const auto* picture = static_cast<const MapPicture*>(image.lookup);
    image.lookup = nullptr;
    image.picture = add_picture(scene, picture->path, picture->asked_for_at);
    if (!picture->contents.empty())
        scene.pictures[image.picture].contents = picture->contents;
}

uint32_t TextureTable::add(ovc::Texture texture, bool is_mix) {
    if (for_ == For::Renderers && texture.image && texture.image->lookup)
        name_picture(scene_, *texture.image);
    const size_t key = key_of(texture);
    const auto [first, last] = by_key_[is_mix].equal_range(key);
    for (auto known = first; known != last; ++known)
        if (scene_.textures[known->second] == texture)
            return known->second;
    const auto number = uint32_t(scene_.textures.size());
    by_key_[is_mix].emplace(key, number);
    on_uv_.resize(number + size_t(1));
    on_uv_[number] =
        texture.on_uv ||
        (!is_mix &&
         std::any_of(texture.stops.begin(), texture.stops.end(), [&](const TextureStop& stop) {
             return stop.texture != kNoTexture && on_uv_[stop.texture];
         }));
    scene_.textures.push_back(std::move(texture));
    return number;
}

/// Returns the brightness of a texture as a formula of x, y and z.
static Formula brightness_of(uint32_t texture) {
    using Kind = FormulaStep::Kind;
    constexpr uint32_t kGray = 5;
    return {{{Kind::Argument, 0},
             {Kind::Argument, 1},
             {Kind::Argument, 2},
             {Kind::Color, texture, kGray}},
            {4}};
}

Pattern TextureTable::pattern_of(const PatternMap& map) {
    Pattern pattern = map.pattern;
    if (map.image_map && !map.stops.empty()) {
        ovc::Texture picture;
        show(*map.image_map, picture);
        pattern.kind = Pattern::Kind::Function;
        pattern.formula = brightness_of(add(std::move(picture), /* is_mix= */ false));
        return pattern;
    }
    if (!map.program)
        return pattern;
    pattern.formula = map.program->formula;
    move_textures(pattern.formula, copy_textures(map.program->textures, [&](ovc::Texture texture) {
                      return add(std::move(texture), /* is_mix= */ false);
                  }));
    return pattern;
}

uint32_t TextureTable::number(const PatternMap& map) {
    std::unordered_map<const PatternMap*, uint32_t>& known_ones = known_[has_uv_];
    if (const auto known = known_ones.find(&map); known != known_ones.end())
        return known->second;
    ovc::Texture texture{pattern_of(map), {}};
    if (map.image_map && map.stops.empty())
        show(*map.image_map, texture);
    for (const MapStop& stop : map.stops) {
        const Pigment& pigment = stop.texture ? stop.texture->pigment : stop.pigment;
        TextureStop made{stop.at, pigment.color};
        if (pigment.pattern)
            made.texture = number(pigment);
        texture.stops.push_back(made);
    }
    return known_ones[&map] = add(std::move(texture), /* is_mix= */ false);
}

uint32_t TextureTable::number(const Pigment& pigment) {
    if (!pigment.pattern)
        return add({{}, {{0, pigment.color}}}, /* is_mix= */ false);
    const uint32_t own = number(*pigment.pattern);
    const bool on_uv = pigment.uv_mapping && has_uv_;
    if (pigment.placed == dmat4(1) && !on_uv)
        return own;
    ovc::Texture moved = scene_.textures[own];
    put_in_front(pigment.placed, moved.pattern);
    moved.on_uv = on_uv;
    return add(std::move(moved), /* is_mix= */ false);
}

PlacedTexture TextureTable::of_pigment(const Pigment& pigment, const dmat4& placed) {
    if (pigment.uv_mapping && has_uv_)
        return placed_texture(number(pigment), dmat4(1));
    if (!pigment.uv_mapping || to_uv_.empty())
        return of_pigments(*pigment.pattern, placed * pigment.placed);
    ovc::Texture wrapped = scene_.textures[number(*pigment.pattern)];
    std::vector<TextureStep>& steps = wrapped.pattern.steps;
    put_in_front(pigment.placed, wrapped.pattern);
    steps.insert(steps.begin(), to_uv_.begin(), to_uv_.end());
    return placed_texture(add(std::move(wrapped), /* is_mix= */ false), dmat4(1));
}

PlacedTexture TextureTable::of_density(const Pigment& density, const dmat4& placed) {
    if (density.pattern)
        return of_pigments(*density.pattern, placed * density.placed);
    return placed_texture(number(density), dmat4(1));
}

PlacedTexture TextureTable::of_pigments(const PatternMap& map, const dmat4& placed) {
    return placed_texture(number(map), placed);
}

PlacedTexture TextureTable::of_materials(const Pigment& mix, std::span<const uint32_t> materials,
                                         const dmat4& placed) {
    const PatternMap& map = *mix.pattern;
    ovc::Texture texture{pattern_of(map), {}};
    for (size_t i = 0; i < map.stops.size(); ++i)
        texture.stops.push_back({map.stops[i].at, {}, materials[i]});
    texture.on_uv = has_uv_ && (mix.uv_mapping || map.on_corners);
    const bool in_formulas = mix.uv_mapping && !has_uv_ && !to_uv_.empty();
    if (!texture.on_uv && !in_formulas)
        return placed_texture(add(std::move(texture), /* is_mix= */ true), placed * mix.placed);
    std::vector<TextureStep>& steps = texture.pattern.steps;
    if (!map.on_corners)
        put_in_front(mix.placed, texture.pattern);
    if (in_formulas)
        steps.insert(steps.begin(), to_uv_.begin(), to_uv_.end());
    return placed_texture(add(std::move(texture), /* is_mix= */ true), dmat4(1));
}

ProgramPtr color_program(const Pigment& pigment) {
    Scene scratch;
    const uint32_t number = TextureTable(scratch, TextureTable::For::Functions).number(pigment);
    scratch.textures.push_back(scratch.textures[number]); // the pigment is the last
    FormulaProgram program{{}, std::move(scratch.textures), {}};
    if (pigment.pattern)
        program.owners.push_back(pigment.pattern);
    return std::make_shared<const FormulaProgram>(std::move(program));
}

bool lets_light_through(const Pigment& pigment) {
    if (!pigment.pattern)
        return pigment.color.filter > 0 || pigment.color.transmit > 0;
    if (const auto& map = pigment.pattern->image_map; map && pigment.pattern->stops.empty())
        return map->image.is_transparent || map->image.filter_all > 0 ||
               map->image.transmit_all > 0;
    const std::vector<MapStop>& stops = pigment.pattern->stops;
    return std::any_of(stops.begin(), stops.end(), [](const MapStop& stop) {
        return lets_light_through(stop.texture ? stop.texture->pigment : stop.pigment);
    });
}

void add_sky(const SkySphere& sky, const Look& look, Scene& scene) {
    TextureTable textures(scene);
    Background& background = scene.background;
    for (const Pigment& pigment : sky.pigments) {
        tell_all(pigment.notes, look);
        if (pigment.pattern) {
            background.layers.push_back(textures.of_pigments(*pigment.pattern, pigment.placed));
        } else if (background.layers.empty()) {
            const Color& color = pigment.color;
            background.horizon = background.zenith =
                color.opacity() * color.rgb + color.through() * background.horizon;
        } else {
            PatternMap one;
            one.stops.resize(1);
            one.stops[0].pigment = pigment;
            background.layers.push_back(textures.of_pigments(one, dmat4(1)));
        }
    }
}

} // namespace ovc::pov
