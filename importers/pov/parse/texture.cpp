// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/texture.h"

#include "importers/file/text.h"
#include "importers/pov/parse/parse_media.h"
#include "importers/pov/parse/pattern.h"
#include "importers/pov/parse/pattern_map.h"
#include "importers/pov/pictures/image_map.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace ovc::pov {

namespace {

/// Reads the amount of diffuse, phong or specular, and whether it is given as an albedo.
float parse_share(Reader& reader, bool& is_albedo) {
    is_albedo = reader.take("albedo");
    return float(parse_float(reader));
}

void parse_reflection(Reader& reader, Surface& surface) {
    Finish& finish = surface.finish;
    finish.fresnel = false;
    finish.metallic_reflection = 0;
    if (!reader.take('{')) {
        finish.reflection = finish.grazing_reflection = parse_color(reader).rgb;
        return;
    }
    finish.reflection = finish.grazing_reflection = parse_color(reader).rgb;
    reader.take_comma();
    const bool is_range = starts_number(reader, reader.peek());
    if (is_range)
        finish.grazing_reflection = parse_color(reader).rgb;
    finish.reflection_falloff = 1;
    while (!reader.take('}')) {
        if (reader.take("fresnel"))
            finish.fresnel = parse_flag(reader);
        else if (reader.take("falloff"))
            finish.reflection_falloff = float(parse_float(reader));
        else if (reader.take("metallic"))
            finish.metallic_reflection =
                starts_number(reader, reader.peek()) ? float(parse_float(reader)) : 1;
        else if (const Token word = reader.peek(); reader.take("exponent")) {
            if (parse_float(reader) != 1)
                surface.notes.push_back(left_out(reader, "a reflection", word));
        } else
            reader.fail_here("a part of reflection { }");
    }
    if (finish.fresnel && !is_range) // one value is what Fresnel's share is multiplied by
        finish.reflection = vec3(0);
}

/// Reads the block of irid.
void parse_irid(Reader& reader, Finish& finish) {
    reader.expect('{', "irid");
    while (!reader.take('}')) {
        if (reader.take("thickness"))
            finish.irid_thickness = float(parse_float(reader));
        else if (reader.take("turbulence"))
            finish.irid_turbulence = float(parse_float(reader));
        else if (!reader.take(','))
            finish.irid = float(parse_float(reader));
    }
}

bool parse_finish_part(Reader& reader, Surface& surface) {
    Finish& finish = surface.finish;
    if (reader.take("ambient"))
        surface.ambient = parse_color(reader).rgb;
    else if (reader.take("emission"))
        surface.emission = parse_color(reader).rgb;
    else if (reader.take("diffuse")) {
        finish.diffuse = parse_share(reader, surface.diffuse_is_albedo);
        if (reader.take(','))
            finish.diffuse_back = float(parse_float(reader));
    } else if (reader.take("crand"))
        finish.crand = float(parse_float(reader));
    else if (reader.take("brilliance"))
        finish.brilliance = float(parse_float(reader));
    else if (reader.take("phong"))
        finish.phong = parse_share(reader, surface.phong_is_albedo);
    else if (reader.take("phong_size"))
        finish.phong_size = float(parse_float(reader));
    else if (reader.take("specular"))
        finish.specular = parse_share(reader, surface.specular_is_albedo);
    else if (reader.take("roughness"))
        finish.roughness = std::max(1e-6f, float(parse_float(reader)));
    else if (reader.take("metallic"))
        finish.metallic = starts_number(reader, reader.peek()) ? float(parse_float(reader)) : 1;
    else if (reader.take("reflection"))
        parse_reflection(reader, surface);
    else if (reader.take("irid"))
        parse_irid(reader, finish);
    else if (reader.take("conserve_energy"))
        finish.conserve_energy = parse_flag(reader);
    else if (reader.take("ior"))
        surface.ior = parse_float(reader);
    else if (const Token token = reader.peek(); reader.take("refraction")) {
        surface.refraction = std::max(0.0f, float(parse_float(reader)));
        if (surface.refraction != 1) // in POV-Ray it does not change shadows
            surface.notes.push_back(
                reader.note("refraction", token.place,
                            "refraction of a finish dims light that casts shadows as well"));
    } else
        return false;
    return true;
}

} // namespace

const Note* left_out(Reader& reader, std::string_view of, const Token& word) {
    assert(word.name);
    const std::string what = fmt::format("{} of {}", word.name->text, of);
    return reader.note(what, word.place, what + " is left out");
}

void skip_arguments(Reader& reader) {
    for (;;) {
        const Token token = reader.peek();
        if (token.is('{')) {
            skip_braces(reader, "a word");
            return;
        }
        if (starts_number(reader, token) && !starts_color(token))
            parse_number(reader);
        else if (starts_text(reader, token))
            parse_text(reader);
        else if (!reader.take(','))
            return;
    }
}

bool take_skipped(Reader& reader, std::initializer_list<std::string_view> words) {
    for (const std::string_view word : words)
        if (reader.take(word)) {
            skip_arguments(reader);
            return true;
        }
    return false;
}

bool take_left_out(Reader& reader, std::initializer_list<std::string_view> words,
                   std::string_view of, Notes& notes) {
    const Token word = reader.peek();
    if (!take_skipped(reader, words))
        return false;
    notes.push_back(left_out(reader, of, word));
    return true;
}

Pigment parse_pigment_parts(Reader& reader, Pigment pigment, char end) {
    const Deeper deeper(reader);
    PatternParts pattern(reader, pigment, MapOf::Pigments);
    const auto plain = [&](const Color& color) {
        pattern.forget();
        pigment.color = color;
        pigment.pattern.reset();
        pigment.holes.reset();
        pigment.notes.clear();
    };
    while (!reader.peek().is(end)) {
        const Token token = reader.peek();
        if (const auto named_pigment = take_named_if<Pigment>(reader)) {
            pigment = *named_pigment;
            pattern.restart();
        } else if (const auto m = take_transform(reader)) {
            pigment.placed = *m * pigment.placed;
        } else if (starts_color(token) ||
                   (token.kind == TokenKind::Name && !token.name->is_keyword &&
                    starts_number(reader, token))) {
            plain(parse_color(reader));
        } else if (token.is("image_map")) {
            reader.next();
            pattern.forget();
            parse_image_map(reader, token, pigment);
        } else if (reader.take("uv_mapping")) {
            pigment.uv_mapping = parse_flag(reader);
        } else if (token.is("quick_color") || token.is("quick_colour")) {
            reader.next();
            parse_color(reader);
        } else if (pattern.take()) {
        } else if (starts_number(reader, token)) {
            plain(parse_color(reader));
        } else if (!take_skipped(reader, {"no_bump_scale"}) && !reader.take(','))
            reader.fail_here("a part of a pigment");
    }
    pattern.finish();
    return pigment;
}

Pigment parse_pigment(Reader& reader, const Pigment& base) {
    reader.expect('{', "pigment");
    Pigment pigment = parse_pigment_parts(reader, base, '}');
    reader.expect('}', "a pigment");
    return pigment;
}

Surface parse_finish(Reader& reader, const Surface& base) {
    const Deeper deeper(reader);
    Surface surface = base;
    reader.expect('{', "finish");
    while (!reader.take('}')) {
        if (const auto named_surface = take_named_if<Surface>(reader))
            surface = *named_surface;
        else if (!parse_finish_part(reader, surface) &&
                 !take_left_out(reader, // the second is of POV-Ray 3.8
                                {"caustics", "fresnel", "reflection_exponent", "subsurface"},
                                "a finish", surface.notes))
            reader.fail_here("a part of a finish");
    }
    return surface;
}

Interior parse_interior(Reader& reader, const Interior& base) {
    const Deeper deeper(reader);
    Interior interior = base;
    reader.expect('{', "interior");
    while (!reader.take('}')) {
        if (const auto named_interior = take_named_if<Interior>(reader))
            interior = *named_interior;
        else if (reader.take("ior"))
            interior.ior = parse_float(reader);
        else if (reader.take("fade_distance"))
            interior.absorption.distance = float(parse_float(reader));
        else if (reader.take("fade_power"))
            interior.absorption.power = float(parse_float(reader));
        else if (reader.take("caustics"))
            interior.caustics = std::max(0.0f, float(parse_float(reader)));
        else if (reader.take("fade_color") || reader.take("fade_colour"))
            interior.absorption.color = parse_color(reader).rgb;
        else if (reader.take("media"))
            interior.media.push_back(parse_media(reader));
        else if (!take_left_out(reader, {"dispersion", "dispersion_samples", "refraction"},
                                "an interior", interior.notes))
            reader.fail_here("a part of an interior");
    }
    return interior;
}

Material parse_material(Reader& reader) {
    const Deeper deeper(reader);
    Material material;
    reader.expect('{', "material");
    while (!reader.take('}')) {
        if (const auto named_material = take_named_if<Material>(reader))
            material = *named_material;
        else if (reader.take("texture"))
            material.texture = material.texture
                                   ? layered(reader, parse_texture(reader), *material.texture)
                                   : parse_texture(reader);
        else if (reader.take("interior"))
            material.interior = parse_interior(reader, material.interior.value_or(Interior{}));
        else if (reader.take("interior_texture"))
            material.inside = parse_texture(reader);
        else if (const auto m = take_transform(reader)) {
            if (material.inside)
                place(*material.inside, *m);
            if (material.texture)
                place(*material.texture, *m);
            if (material.interior)
                place(*material.interior, *m);
        } else
            reader.fail_here("a part of a material");
    }
    return material;
}

Texture mix_of(PatternPtr map) {
    Texture all = *map->stops.front().texture;
    all.mix = {};
    all.mix.pattern = std::move(map);
    return all;
}

Texture on_texture_coordinates(Texture texture) {
    texture.pigment.uv_mapping = true;
    if (texture.under)
        texture.under = std::make_shared<const Texture>(on_texture_coordinates(*texture.under));
    if (!texture.mix.pattern || texture.mix.pattern->on_corners)
        return texture;
    texture.mix.uv_mapping = true;
    auto map = std::make_shared<PatternMap>(*texture.mix.pattern);
    for (MapStop& stop : map->stops)
        if (stop.texture)
            stop.texture = std::make_shared<const Texture>(on_texture_coordinates(*stop.texture));
    texture.mix.pattern = std::move(map);
    return texture;
}

/// Reads `tiles { texture { … } tile2 texture { … } }`, a checker of two textures in old scenes,
/// whose second texture fills the cells that a checker's first one does.
static Texture parse_tiles(Reader& reader) {
    reader.expect('{', "tiles");
    auto map = std::make_shared<PatternMap>();
    map->pattern.kind = Pattern::Kind::Checker;
    const auto add = [&](const Texture& texture) {
        MapStop stop;
        stop.at = double(map->stops.size());
        stop.texture = std::make_shared<const Texture>(texture);
        map->stops.push_back(std::move(stop));
    };
    while (!reader.take('}')) {
        if (reader.take("texture"))
            add(parse_texture(reader));
        else if (const auto texture = take_named_if<Texture>(reader))
            add(*texture);
        else if (!reader.take("tile2") && !reader.take(','))
            reader.fail_here("'}' or a texture of tiles");
    }
    if (map->stops.size() == 2)
        std::swap(map->stops[0].texture, map->stops[1].texture);
    count_parts(reader, *map);
    return map->stops.empty() ? reader.defaults : mix_of(std::move(map));
}

/// Reads `material_map { PICTURE texture { … } … }`, whose picture chooses one of the textures.
static Texture parse_material_map(Reader& reader, const Token& word) {
    const MaterialValues values_for = parse_material_picture(reader, word);
    std::vector<TexturePtr> textures;
    while (!reader.take('}')) {
        if (reader.take("texture"))
            textures.push_back(std::make_shared<const Texture>(parse_texture(reader)));
        else if (const auto texture = take_named_if<Texture>(reader))
            textures.push_back(std::make_shared<const Texture>(*texture));
        else if (!reader.take(','))
            reader.fail_here("'}' or a texture of a material_map");
    }
    if (textures.empty() || textures.size() > 256)
        reader.fail(
            word.place,
            fmt::format("found a material_map of {} textures, expected 1 to 256", textures.size()));
    const ValueMap values = values_for(reader, textures.size());
    if (!values.image) {
        Texture first = *textures.front();
        first.notes.push_back(values.why_not);
        return first;
    }
    auto map = std::make_shared<PatternMap>();
    map->image_map = values.image;
    for (size_t i = 0; i < textures.size(); ++i)
        for (const double side : {-0.5, 0.5}) { // of the range of the picture's value for texture i
            MapStop stop;
            stop.at = (double(i) + side) / 255;
            stop.texture = textures[i];
            map->stops.push_back(std::move(stop));
        }
    count_parts(reader, *map);
    return mix_of(std::move(map));
}

/// A mix of textures that has been read becomes a part of the texture.
static void take_mix(Reader& reader, PatternParts& mix, Texture& texture) {
    mix.finish();
    if (mix.stops().empty() && !texture.mix.pattern)
        return;
    const std::vector<MapStop>& stops =
        texture.mix.pattern ? texture.mix.pattern->stops : mix.stops();
    const auto is_texture = [](const MapStop& stop) { return stop.texture != nullptr; };
    if (!std::all_of(stops.begin(), stops.end(), is_texture))
        reader.fail(reader.place(),
                    "found colors in a map or list of a texture, expected textures");
    const Texture& first = *stops.front().texture;
    const bool on_uv = texture.pigment.uv_mapping;
    texture.pigment = first.pigment;
    texture.surface = first.surface;
    texture.normal = first.normal;
    if (!texture.mix.pattern) {
        texture.pigment = {};
        texture.pigment.color = texture.mix.color;
    }
    if (on_uv)
        texture = on_texture_coordinates(texture);
}

Texture parse_texture_parts(Reader& reader, Texture texture, char end) {
    const Deeper deeper(reader);
    PatternParts mix(reader, texture.mix, MapOf::Textures);
    bool keeps_depth = false;
    while (!reader.peek().is(end)) {
        const Token token = reader.peek();
        if (const auto named_texture = take_named_if<Texture>(reader)) {
            texture = *named_texture;
            mix.restart();
        } else if (const auto named_pigment = take_named_if<Pigment>(reader))
            texture.pigment = *named_pigment;
        else if (const auto named_finish = take_named_if<Surface>(reader))
            texture.surface = *named_finish;
        else if (const auto named_normal = take_named_if<Normal>(reader))
            texture.normal = *named_normal;
        else if (const auto m = take_transform(reader))
            place(texture, *m);
        else if (reader.take("pigment"))
            texture.pigment = parse_pigment(reader, texture.pigment);
        else if (reader.take("finish"))
            texture.surface = parse_finish(reader, texture.surface);
        else if (reader.take("uv_mapping"))
            texture.pigment.uv_mapping = parse_flag(reader);
        else if (reader.take("tiles"))
            texture = parse_tiles(reader);
        else if (reader.take("material_map"))
            texture = parse_material_map(reader, token);
        else if (reader.take("normal"))
            texture.normal = parse_normal(reader, texture.normal);
        else if (reader.take("no_bump_scale"))
            keeps_depth = true;
        else if (!mix.take() && !reader.take(','))
            reader.fail_here("a part of a texture");
    }
    texture.normal.keeps_depth = texture.normal.keeps_depth || keeps_depth;
    take_mix(reader, mix, texture);
    return texture;
}

Texture parse_texture(Reader& reader) {
    reader.expect('{', "texture");
    Texture texture = parse_texture_parts(reader, reader.defaults, '}');
    reader.expect('}', "a texture");
    return texture;
}

void place(Texture& texture, const dmat4& by) {
    texture.pigment.placed = by * texture.pigment.placed;
    texture.mix.placed = by * texture.mix.placed;
    texture.normal.pattern.placed = by * texture.normal.pattern.placed;
    if (texture.under) {
        Texture under = *texture.under;
        place(under, by);
        texture.under = std::make_shared<const Texture>(std::move(under));
    }
}

void place(Interior& interior, const dmat4& by) {
    for (Media& media : interior.media)
        for (Pigment& density : media.densities)
            density.placed = by * density.placed;
}

static Texture on_top(const Texture& upper, const Texture& lower) {
    Texture both = upper;
    both.pigment.holes.reset(); // the lower layer fills them
    if (!upper.under) {
        both.under = std::make_shared<const Texture>(lower);
        return both;
    }
    both.under = std::make_shared<const Texture>(on_top(*upper.under, lower));
    return both;
}

Texture layered(Reader& reader, const Texture& upper, const Texture& lower) {
    Texture both = on_top(upper, lower);
    check_parts(reader, both);
    return both;
}

} // namespace ovc::pov
