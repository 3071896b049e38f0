// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/pattern_map.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pov {

namespace {

MapStop stop(double at, const vec3& rgb) {
    MapStop made;
    made.at = at;
    made.pigment.color.rgb = rgb;
    return made;
}

/// Reads a pigment or texture of a list or map. `end` ends an entry of a map; it is 0 for a list.
MapStop parse_entry(Reader& reader, MapOf of, char end) {
    MapStop made;
    const auto take = [&](const Texture& texture) {
        made.texture = std::make_shared<const Texture>(texture);
    };
    const auto take_normal = [&](const Normal& normal) {
        made.normal = std::make_shared<const Normal>(normal);
    };
    if (of == MapOf::Normals && end != 0)
        take_normal(parse_normal_parts(reader, reader.defaults.normal, end));
    else if (reader.take("normal"))
        take_normal(parse_normal(reader, reader.defaults.normal));
    else if (of == MapOf::Textures && end != 0)
        take(parse_texture_parts(reader, reader.defaults, end));
    else if (reader.take("texture"))
        take(parse_texture(reader));
    else if (const auto texture = take_named<Texture>(reader); texture)
        take(*texture);
    else if (reader.take("pigment"))
        made.pigment = parse_pigment(reader, reader.defaults.pigment);
    else if (const auto pigment = take_named_if<Pigment>(reader); pigment && end == 0)
        made.pigment = *pigment;
    else if (end == 0)
        made.pigment.color = parse_color(reader);
    else
        made.pigment = parse_pigment_parts(reader, pigment.value_or(reader.defaults.pigment), end);
    return made;
}

/// Returns whether a further entry of a list follows, and takes the comma before it.
bool list_goes_on(Reader& reader) {
    if (reader.take(','))
        return true;
    const Token next = reader.peek();
    return starts_color(next) || next.is("pigment") || next.is("texture") || next.is("normal") ||
           named<Number>(reader, next);
}

bool starts_entry(const Reader& reader, const Token& token) {
    return starts_number(reader, token) || token.is("pigment") || token.is("texture") ||
           token.is("normal") || named<Pigment>(reader, token) || named<Texture>(reader, token);
}

/// Reads `0.3 color …`, `0.3 0.5 color … color …` or a pigment or texture, behind the [.
void parse_stop(Reader& reader, MapOf of, std::vector<MapStop>& stops) {
    // Entries of `average` may come without a number.
    const bool has_number = starts_number(reader, reader.peek()) && !starts_color(reader.peek());
    // POV-Ray keeps places in a map as floats, which decides where a value meets one.
    const double at = has_number ? double(float(parse_float(reader))) : 1;
    reader.take_comma();
    const Token token = reader.peek();
    const auto add_color = [&](double where, const Color& color) {
        stops.push_back(stop(where, vec3(0)));
        stops.back().pigment.color = color;
    };
    if (of != MapOf::Normals &&
        (token.kind == TokenKind::Number || token.is('(') || token.is('<'))) {
        const Number n = parse_number(reader);
        reader.take_comma();
        if (reader.peek().is(']')) {
            add_color(at, color_of(resized(reader, n, 5)));
        } else {
            add_color(at, parse_color(reader));
            reader.take_comma();
            add_color(double(float(n.v[0])), parse_color(reader));
        }
        return;
    }
    if (starts_color(token) && of != MapOf::Normals) {
        add_color(at, parse_color(reader));
        return;
    }
    stops.push_back(parse_entry(reader, of, ']'));
    stops.back().at = at;
}

} // namespace

std::vector<MapStop> default_stops(const Token* word, Pattern::Kind kind) {
    switch (kind) {
    case Pattern::Kind::Agate:
        return {stop(0, vec3(1)), stop(0.5, {0.95f, 0.75f, 0.5f}), stop(0.6, {1, 0.7f, 0.4f}),
                stop(1, {0.6f, 0.3f, 0})};
    case Pattern::Kind::Bozo:
        if (!word || !word->is("bozo"))
            break;
        return {stop(0.4, vec3(1)),   stop(0.4, {0, 1, 0}), stop(0.6, {0, 1, 0}),
                stop(0.6, {0, 0, 1}), stop(0.8, {0, 0, 1}), stop(0.8, {1, 0, 0})};
    case Pattern::Kind::Brick:
        return {stop(0, vec3(0.5f)), stop(1, {0.6f, 0.15f, 0.15f})};
    case Pattern::Kind::Checker:
        return {stop(0, {0, 0, 1}), stop(1, {0, 1, 0})};
    case Pattern::Kind::Cubic:
        return {stop(0, {1, 0, 0}), stop(1, {0, 1, 0}), stop(2, {0, 0, 1}),
                stop(3, {1, 1, 0}), stop(4, {0, 1, 1}), stop(5, {1, 0, 1})};
    case Pattern::Kind::Fractal: // povray 3.7.0.10 gives mandel alone these, which change early
        if (!word || !word->is("mandel"))
            break;
        return {stop(0.001, vec3(0)), stop(0.001, {0, 1, 1}), stop(0.012, {1, 1, 0}),
                stop(0.015, {1, 0, 1}), stop(0.1, {0, 1, 1})};
    case Pattern::Kind::Hexagon:
        return {stop(0, {0, 0, 1}), stop(1, {0, 1, 0}), stop(2, {1, 0, 0})};
    case Pattern::Kind::Marble:
        return {stop(0, {0.9f, 0.8f, 0.8f}), stop(0.9, {0.9f, 0.08f, 0.08f}), stop(0.9, vec3(0))};
    case Pattern::Kind::Radial:
        return {stop(0, {0, 1, 1}), stop(0.333, {1, 1, 0}), stop(0.666, {1, 0, 1}),
                stop(1, {0, 1, 1})};
    case Pattern::Kind::Square:
        return {stop(0, {1, 0, 0}), stop(1, {0, 1, 0}), stop(2, {0, 0, 1}), stop(3, {1, 1, 0})};
    case Pattern::Kind::Triangular:
        return {stop(0, {1, 0, 0}), stop(1, {0, 1, 0}), stop(2, {0, 0, 1}),
                stop(3, {1, 1, 0}), stop(4, {0, 1, 1}), stop(5, {1, 0, 1})};
    case Pattern::Kind::Wood:
        return {stop(0.6, {0.666f, 0.312f, 0.2f}), stop(0.6, {0.4f, 0.133f, 0.066f})};
    default:
        break;
    }
    return {stop(0, vec3(0)), stop(1, vec3(1))};
}

std::vector<MapStop> parse_entries(Reader& reader, MapOf of) {
    std::vector<MapStop> list;
    if (!starts_entry(reader, reader.peek()))
        return list;
    do {
        list.push_back(parse_entry(reader, of, 0));
        list.back().at = double(list.size() - 1);
    } while (list_goes_on(reader));
    return list;
}

ColorMap parse_map(Reader& reader, MapOf of) {
    const Deeper deeper(reader);
    reader.expect('{', "a map");
    ColorMap made;
    while (!reader.take('}')) {
        if (const auto map = take_named_if<ColorMap>(reader)) {
            reader.expect('}', "the name of a map");
            return *map;
        }
        reader.expect('[', "a map's brace");
        parse_stop(reader, of, made.stops);
        // More may follow the color, such as a second one. It is skipped.
        while (!reader.peek().is(']'))
            if (const Token rest = reader.next(); rest.kind == TokenKind::End)
                reader.fail(rest.place, "found no ']' in a map");
        reader.expect(']', "an entry of a map");
    }
    return made;
}

/// How many patterns there are, and how deep they lie in each other.
struct PatternCount {
    uint64_t parts = 0, depth = 0;

    void add(const PatternCount& other) {
        parts += other.parts;
        depth = std::max(depth, other.depth);
    }
};

static PatternCount count_of(const Pigment& pigment) {
    return pigment.pattern ? PatternCount{pigment.pattern->parts, pigment.pattern->depth}
                           : PatternCount{};
}

static PatternCount count_of(const Texture& texture) {
    PatternCount count;
    if (texture.under) {
        count = count_of(*texture.under);
        ++count.depth;
    }
    for (const Pigment* const part : {&texture.pigment, &texture.mix, &texture.normal.pattern})
        count.add(count_of(*part));
    return count;
}

static void check(Reader& reader, const PatternCount& count) {
    constexpr uint64_t kMaxParts = 100'000; // far beyond what real scenes mix
    if (count.parts > kMaxParts)
        reader.fail(reader.place(), fmt::format("found a mix of more than {} patterns, counting "
                                                "those within each other",
                                                kMaxParts));
    if (count.depth > reader.limits.depth)
        reader.fail(reader.place(), fmt::format("found patterns or layers more than {} deep in "
                                                "each other",
                                                reader.limits.depth));
}

void count_parts(Reader& reader, PatternMap& map) {
    PatternCount count;
    for (const MapStop& stop : map.stops) {
        count.add(count_of(stop.pigment));
        if (stop.texture)
            count.add(count_of(*stop.texture));
        if (stop.normal)
            count.add(count_of(stop.normal->pattern));
    }
    map.parts = ++count.parts;
    map.depth = ++count.depth;
    check(reader, count);
}

void check_parts(Reader& reader, const Texture& texture) {
    check(reader, count_of(texture));
}

Color average_of(const std::vector<MapStop>& stops) {
    std::vector<MapStop> all = stops;
    if (all.empty())
        return {vec3(0.5f)};
    std::stable_sort(all.begin(), all.end(),
                     [](const MapStop& a, const MapStop& b) { return a.at < b.at; });
    all.insert(all.begin(), all.front());
    all.front().at = std::min(0.0, all.front().at);
    all.push_back(all.back());
    all.back().at = std::max(1.0, all.back().at);
    Color sum;
    double weights = 0;
    for (size_t i = 0; i + 1 < all.size(); ++i) {
        const double width = std::clamp(all[i + 1].at, 0.0, 1.0) - std::clamp(all[i].at, 0.0, 1.0);
        weights += width;
        for (const MapStop* end : {&all[i], &all[i + 1]}) {
            const Color& color = end->average();
            sum.rgb += float(width / 2) * color.rgb;
            sum.filter += float(width / 2) * color.filter;
            sum.transmit += float(width / 2) * color.transmit;
        }
    }
    return weights > 0 ? sum : all.front().average();
}

} // namespace ovc::pov
