// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/texture.h"

#include "importers/file/text.h"
#include "importers/pov/pictures/image_map.h"
#include "importers/pov/values/function.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace ovc::pov {

namespace {

template <size_t N>
bool is_one_of(const Token& token, const std::string_view (&words)[N]) {
    return token.kind == TokenKind::Name &&
           std::find(std::begin(words), std::end(words), token.name->text) != std::end(words);
}

/// Returns whether the pattern takes a list of colors, pigments or textures.
bool is_list_pattern(const Token& token) {
    static constexpr std::string_view kWords[] = {"brick",   "checker",    "cubic",
                                                  "hexagon", "square",     "tiles",
                                                  "object",  "triangular", "tiling_list"};
    return is_one_of(token, kWords);
}

/// Returns whether the pattern takes a map. Without one it runs from black to white.
bool is_map_pattern(const Token& token) {
    static constexpr std::string_view kWords[] = {
        "agate",    "aoi",          "average",         "boxed",     "bozo",      "bumps",
        "cells",    "crackle",      "cylindrical",     "dents",     "facets",    "gradient",
        "granite",  "julia",        "leopard",         "magnet",    "mandel",    "marble",
        "onion",    "pavement",     "pigment_pattern", "planar",    "potential", "quilted",
        "radial",   "ripples",      "slope",           "spherical", "spiral1",   "spiral2",
        "spotted",  "tiling",       "waves",           "wood",      "wrinkles",  "density_file",
        "function", "image_pattern"};
    return is_one_of(token, kWords);
}

/// Returns whether the token is a word of the language, not an identifier.
bool is_word(const Token& token) {
    return token.kind == TokenKind::Name && token.name->is_keyword;
}

bool is_color_map(const Token& token) {
    static constexpr std::string_view kWords[] = {"color_map", "colour_map", "pigment_map",
                                                  "texture_map"};
    return is_one_of(token, kWords);
}

/// The weighted mean of colors.
class Mean {
public:
    void add(const Color& color, float weight) {
        sum_.rgb += weight * color.rgb;
        sum_.filter += weight * color.filter;
        sum_.transmit += weight * color.transmit;
        weight_ += weight;
    }
    Color color() const {
        const float scale = weight_ > 0 ? 1 / weight_ : 0;
        return {scale * sum_.rgb, scale * sum_.filter, scale * sum_.transmit};
    }
    bool empty() const { return weight_ == 0; }

private:
    Color sum_;
    float weight_ = 0;
};

Color mean_of(const Pigment& p) {
    if (!p.other)
        return p.color;
    Mean mean;
    mean.add(p.color, 1);
    mean.add(*p.other, 1);
    return mean.color();
}

Notes average_note(Reader& reader, const Token& pattern) {
    return {reader.note("pattern", pattern.place,
                        fmt::format("patterns such as {} are drawn by their average color",
                                    ovc::quoted(pattern.name->text)))};
}

Pigment parse_pigment_body(Reader& reader, Pigment pigment, char end);

/// Reads one color of a list or map: a color, pigment or texture. `end` ends an entry of a map; it
/// is 0 for a list.
Color parse_entry(Reader& reader, char end) {
    if (reader.take("pigment"))
        return mean_of(parse_pigment(reader, reader.defaults.pigment));
    if (reader.take("texture"))
        return mean_of(parse_texture(reader).pigment);
    if (const auto texture = take_named<Texture>(reader); texture)
        return mean_of(texture->pigment);
    if (end == 0)
        return parse_color(reader);
    return mean_of(parse_pigment_body(reader, reader.defaults.pigment, end));
}

/// Returns whether a further entry of a list pattern follows, and takes the comma before it.
bool list_goes_on(Reader& reader) {
    if (reader.take(','))
        return true;
    const Token next = reader.peek();
    return starts_color(next) || next.is("pigment") || next.is("texture") ||
           named<Number>(reader, next);
}

void parse_list(Reader& reader, const Token& pattern, Pigment& pigment) {
    if (pattern.is("object"))
        skip_braces(reader, "object");
    if (pattern.is("square") || pattern.is("tiles") || pattern.is("triangular"))
        pigment.color = {vec3(0.5f)};
    std::vector<Color> colors;
    const Token first = reader.peek();
    if (starts_number(reader, first) || first.is("pigment") || first.is("texture") ||
        named<Pigment>(reader, first) || named<Texture>(reader, first)) {
        do {
            const Token next = reader.peek();
            if (const auto named_pigment = named<Pigment>(reader, next)) {
                colors.push_back(mean_of(*named_pigment));
                reader.next();
            } else
                colors.push_back(parse_entry(reader, 0));
        } while (list_goes_on(reader));
    }
    if (pattern.is("checker")) {
        static const std::array<Color, 2> kDefaults = {Color{{0, 0, 1}}, Color{{0, 1, 0}}};
        pigment.color = colors.size() > 0 ? colors[0] : kDefaults[0];
        pigment.other = colors.size() > 1 ? colors[1] : kDefaults[1];
        pigment.placed = dmat4(1);
        pigment.holes.reset();
        pigment.notes.clear();
        if (pigment.color.opacity() != 1 || pigment.other->opacity() != 1)
            pigment.notes = {
                reader.note("checker", pattern.place,
                            "a checker lets through all over what its first color does")};
        return;
    }
    Mean mean;
    for (const Color& color : colors)
        mean.add(color, 1);
    if (!mean.empty())
        pigment.color = mean.color();
    pigment.other.reset();
    pigment.holes.reset();
    pigment.notes = average_note(reader, pattern);
}

/// The average color of a map pattern without a map.
const Color kMiddle{vec3(0.5f)};

void set_plain(Pigment& pigment, const Color& color) {
    pigment.color = color;
    pigment.other.reset();
    pigment.holes.reset();
    pigment.notes.clear();
}

Pigment parse_pigment_body(Reader& reader, Pigment pigment, char end) {
    const Deeper deeper(reader);
    bool mapped = false;
    while (!reader.peek().is(end)) {
        const Token token = reader.peek();
        if (const auto named_pigment = take_named_if<Pigment>(reader)) {
            pigment = *named_pigment;
        } else if (const auto m = take_transform(reader)) {
            pigment.placed = *m * pigment.placed;
        } else if (starts_color(token) ||
                   (token.kind == TokenKind::Name && !token.name->is_keyword &&
                    starts_number(reader, token))) {
            set_plain(pigment, parse_color(reader));
        } else if (is_color_map(token)) {
            reader.next();
            pigment.color = parse_map(reader).average;
            pigment.other.reset();
            pigment.holes.reset();
            mapped = true;
        } else if (is_list_pattern(token)) {
            reader.next();
            parse_list(reader, token, pigment);
        } else if (token.is("image_map")) {
            reader.next();
            parse_image_map(reader, token, pigment);
        } else if (reader.take("uv_mapping")) {
            pigment.uv_mapping = parse_flag(reader);
            if (pigment.other)
                pigment.notes = {left_out(reader, "a checker", token)};
        } else if (token.is("quick_color") || token.is("quick_colour")) {
            reader.next();
            parse_color(reader);
        } else if (is_map_pattern(token)) {
            reader.next();
            pigment.notes = average_note(reader, token);
            if (!mapped)
                pigment.color = kMiddle;
            pigment.other.reset();
            pigment.holes.reset();
            if (token.is("function"))
                parse_function(reader);
            else
                skip_arguments(reader);
        } else if (is_word(token)) {
            reader.next(); // turbulence, octaves, warp and the like
            if (pigment.other)
                pigment.notes = {left_out(reader, "a checker", token)};
            skip_arguments(reader);
        } else if (starts_number(reader, token)) {
            set_plain(pigment, parse_color(reader));
        } else if (!reader.take(','))
            reader.fail_here("a part of a pigment");
    }
    return pigment;
}

struct MapEntry {
    double at;
    Color color;
};

Color average_of(std::vector<MapEntry> entries) {
    if (entries.empty())
        return kMiddle;
    std::stable_sort(entries.begin(), entries.end(),
                     [](const MapEntry& a, const MapEntry& b) { return a.at < b.at; });
    entries.insert(entries.begin(), {0, entries.front().color});
    entries.push_back({1, entries.back().color});
    Mean mean;
    for (size_t i = 0; i + 1 < entries.size(); ++i) {
        const float width =
            float(std::clamp(entries[i + 1].at, 0.0, 1.0) - std::clamp(entries[i].at, 0.0, 1.0));
        mean.add(entries[i].color, 0.5f * width);
        mean.add(entries[i + 1].color, 0.5f * width);
    }
    return mean.empty() ? entries.front().color : mean.color();
}

bool is_texture_pattern(const Token& token) {
    return is_list_pattern(token) || is_map_pattern(token);
}

/// Reads the amount of diffuse, phong or specular, which may be given as an albedo.
float parse_share(Reader& reader) {
    reader.take("albedo");
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
    if (starts_number(reader, reader.peek()))
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
        else if (reader.take("exponent"))
            parse_float(reader);
        else
            reader.fail_here("a part of reflection { }");
    }
}

bool parse_finish_part(Reader& reader, Surface& surface) {
    Finish& finish = surface.finish;
    if (reader.take("ambient"))
        surface.ambient = parse_color(reader).rgb;
    else if (reader.take("emission"))
        surface.emission = parse_color(reader).rgb;
    else if (reader.take("diffuse")) {
        finish.diffuse = parse_share(reader);
        if (reader.take(','))
            parse_float(reader);
    } else if (reader.take("brilliance"))
        finish.brilliance = float(parse_float(reader));
    else if (reader.take("phong"))
        finish.phong = parse_share(reader);
    else if (reader.take("phong_size"))
        finish.phong_size = float(parse_float(reader));
    else if (reader.take("specular"))
        finish.specular = parse_share(reader);
    else if (reader.take("roughness"))
        finish.roughness = std::max(1e-6f, float(parse_float(reader)));
    else if (reader.take("metallic"))
        finish.metallic = starts_number(reader, reader.peek()) ? float(parse_float(reader)) : 1;
    else if (reader.take("reflection"))
        parse_reflection(reader, surface);
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

const Note* normal_note(Reader& reader, const Token& word) {
    return reader.note("normal", word.place, "normal patterns are left out");
}

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

ColorMap parse_map(Reader& reader) {
    const Deeper deeper(reader);
    reader.expect('{', "a map");
    std::vector<MapEntry> entries;
    while (!reader.take('}')) {
        if (const auto map = take_named_if<ColorMap>(reader)) {
            reader.expect('}', "the name of a map");
            return *map;
        }
        reader.expect('[', "a map's brace");
        // Entries of `average` may come without a number.
        const bool has_number =
            starts_number(reader, reader.peek()) && !starts_color(reader.peek());
        const double at = has_number ? parse_float(reader) : double(entries.size());
        reader.take_comma();
        const Token token = reader.peek();
        if (token.kind == TokenKind::Number || token.is('(') || token.is('<')) {
            const Number n = parse_number(reader);
            reader.take_comma();
            if (reader.peek().is(']'))
                entries.push_back({at, color_of(resized(reader, n, 5))});
            else { // [from to color color]
                entries.push_back({at, parse_color(reader)});
                reader.take_comma();
                entries.push_back({n.v[0], parse_color(reader)});
            }
        } else {
            const bool plain = starts_color(token);
            entries.push_back({at, plain ? parse_color(reader) : parse_entry(reader, ']')});
        }
        // More may follow the color, such as a second one. It is skipped.
        while (!reader.peek().is(']'))
            if (const Token rest = reader.next(); rest.kind == TokenKind::End)
                reader.fail(rest.place, "found no ']' in a map");
        reader.expect(']', "an entry of a map");
    }
    return {average_of(std::move(entries))};
}

Pigment parse_pigment(Reader& reader, const Pigment& base) {
    reader.expect('{', "pigment");
    Pigment pigment = parse_pigment_body(reader, base, '}');
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
        else if (!parse_finish_part(reader, surface)) {
            const Token token = reader.next(); // crand, irid and the like
            if (!is_word(token))
                reader.fail(token.place,
                            fmt::format("found {}, expected a part of a finish", found(token)));
            surface.notes.push_back(left_out(reader, "a finish", token));
            skip_arguments(reader);
        }
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
        else {
            const Token token = reader.next();
            if (!is_word(token))
                reader.fail(token.place,
                            fmt::format("found {}, expected a part of an interior", found(token)));
            interior.notes.push_back(left_out(reader, "an interior", token));
            skip_arguments(reader);
        }
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
            material.texture = material.texture ? layered(reader, parse_texture(reader),
                                                          *material.texture, reader.place())
                                                : parse_texture(reader);
        else if (reader.take("interior"))
            material.interior = parse_interior(reader, material.interior.value_or(Interior{}));
        else if (const Token token = reader.peek(); reader.take("interior_texture")) {
            Interior inside = material.interior.value_or(Interior{});
            inside.notes.push_back(left_out(reader, "a material", token));
            material.interior = inside;
            skip_braces(reader, "interior_texture");
        } else if (const auto m = take_transform(reader)) {
            if (material.texture)
                material.texture->pigment.placed = *m * material.texture->pigment.placed;
        } else
            reader.fail_here("a part of a material");
    }
    return material;
}

/// Reads `tiles { texture { … } tile2 texture { … } }`, a checker of two textures in old scenes.
/// The result has the finish of the first.
static Texture parse_tiles(Reader& reader) {
    reader.expect('{', "tiles");
    std::vector<Texture> both;
    while (!reader.take('}')) {
        if (reader.take("texture"))
            both.push_back(parse_texture(reader));
        else if (const auto texture = take_named_if<Texture>(reader))
            both.push_back(*texture);
        else if (!reader.take("tile2") && !reader.take(','))
            reader.fail_here("'}' or a texture of tiles");
    }
    if (both.empty())
        return reader.defaults;
    both.front().pigment.other = mean_of(both.back().pigment);
    return both.front();
}

Texture parse_texture(Reader& reader) {
    const Deeper deeper(reader);
    reader.expect('{', "texture");
    Texture texture = reader.defaults;
    while (!reader.take('}')) {
        const Token token = reader.peek();
        if (const auto named_texture = take_named_if<Texture>(reader))
            texture = *named_texture;
        else if (const auto named_pigment = take_named_if<Pigment>(reader))
            texture.pigment = *named_pigment;
        else if (const auto named_finish = take_named_if<Surface>(reader))
            texture.surface = *named_finish;
        else if (take_named_if<Opaque>(reader))
            texture.notes.push_back(normal_note(reader, token));
        else if (const auto m = take_transform(reader))
            texture.pigment.placed = *m * texture.pigment.placed;
        else if (reader.take("pigment"))
            texture.pigment = parse_pigment(reader, texture.pigment);
        else if (reader.take("finish"))
            texture.surface = parse_finish(reader, texture.surface);
        else if (reader.take("uv_mapping"))
            texture.pigment.uv_mapping = parse_flag(reader);
        else if (reader.take("tiles"))
            texture = parse_tiles(reader);
        else if (reader.take("normal")) {
            texture.notes.push_back(normal_note(reader, token));
            skip_braces(reader, "normal");
        } else if (is_texture_pattern(token) || is_color_map(token)) {
            reader.next();
            if (is_color_map(token))
                texture.pigment.color = parse_map(reader).average;
            else if (is_list_pattern(token))
                parse_list(reader, token, texture.pigment);
            else {
                texture.pigment.notes = average_note(reader, token);
                skip_arguments(reader);
            }
        } else if (is_word(token)) {
            reader.next();
            skip_arguments(reader);
        } else if (!reader.take(','))
            reader.fail_here("a part of a texture");
    }
    return texture;
}

Texture layered(Reader& reader, const Texture& upper, const Texture& lower, const Place& at) {
    const Color& over = upper.pigment.color;
    if (over.filter <= 0 && over.transmit <= 0 && !upper.pigment.other)
        return upper;
    Texture both = upper;
    both.pigment.holes.reset(); // what is below fills them
    const Color under = mean_of(lower.pigment);
    const auto seen = [&](const Color& c) {
        const vec3 through = c.filter * c.rgb + vec3(c.transmit);
        Color sum;
        sum.rgb = std::max(0.0f, c.opacity()) * c.rgb + through * under.rgb;
        const float left = std::clamp(c.filter + c.transmit, 0.0f, 1.0f);
        sum.filter = left * under.filter;
        sum.transmit = left * under.transmit;
        return sum;
    };
    both.pigment.color = seen(over);
    if (upper.pigment.other)
        both.pigment.other = seen(*upper.pigment.other);
    both.surface = lower.surface;
    both.surface.ior = upper.surface.ior; // as in POV-Ray
    both.surface.refraction = upper.surface.refraction;
    both.notes.insert(both.notes.end(), lower.notes.begin(), lower.notes.end());
    both.notes.push_back(reader.note("layers", at, "layers of a texture are drawn as one"));
    return both;
}

} // namespace ovc::pov
