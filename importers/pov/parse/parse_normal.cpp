// SPDX-License-Identifier: Apache-2.0
// Reads normal { }.
#include "importers/pov/parse/pattern.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/pictures/image_map.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc::pov {

/// Returns how the pattern of this name tilts normals.
static Bump::Kind bump_of(const Token& pattern) {
    if (pattern.is("bumps"))
        return Bump::Kind::Noise;
    if (pattern.is("dents"))
        return Bump::Kind::Dents;
    if (pattern.is("ripples"))
        return Bump::Kind::Ripples;
    if (pattern.is("waves"))
        return Bump::Kind::Waves;
    if (pattern.is("facets"))
        return Bump::Kind::Facets;
    if (pattern.is("quilted"))
        return Bump::Kind::Quilted;
    return pattern.is("wrinkles") ? Bump::Kind::Wrinkles : Bump::Kind::Height;
}

static const Note* uv_mapping_left_out(Reader& reader, const Place& at) {
    return reader.note("normal uv_mapping", at, "uv_mapping of a normal is left out");
}

/// Reads the block of a bump_map, whose picture takes the place of the normal's pattern.
static void take_bump_map(Reader& reader, const Token& word, Normal& normal) {
    const ValueMap values = parse_value_map(reader, word);
    normal.kind = Bump::Kind::Picture;
    normal.profile.clear();
    normal.amount = values.bump_size.value_or(normal.amount);
    normal.pattern = {};
    if (!values.image) {
        normal.pattern.notes = {values.why_not};
        return;
    }
    auto map = std::make_shared<PatternMap>();
    map->image_map = values.image;
    normal.pattern.pattern = std::move(map);
}

std::vector<SlopeStop> parse_slope_map(Reader& reader) {
    std::vector<SlopeStop> stops;
    reader.expect('{', "slope_map");
    while (!reader.take('}')) {
        if (const auto map = take_named_if<ColorMap>(reader)) {
            stops = map->slopes;
            continue;
        }
        reader.expect('[', "slope_map's brace");
        SlopeStop stop{parse_float(reader)};
        reader.take_comma();
        const Number n = resized(reader, parse_number(reader), 2);
        stop.height = n.v[0];
        stop.slope = n.v[1];
        reader.expect(']', "an entry of a slope_map");
        stops.push_back(stop);
    }
    std::stable_sort(stops.begin(), stops.end(),
                     [](const SlopeStop& a, const SlopeStop& b) { return a.at < b.at; });
    return stops;
}

Normal parse_normal_parts(Reader& reader, const Normal& base, char end) {
    const Deeper deeper(reader);
    Normal normal = base;
    std::optional<Place> on_uv; // noted at the end, because a pattern forgets what was before it
    PatternParts pattern(reader, normal.pattern, MapOf::Normals);
    while (!reader.peek().is(end)) {
        const Token token = reader.peek();
        if (const auto named_normal = take_named_if<Normal>(reader)) {
            normal = *named_normal;
            pattern.restart();
        } else if (const auto m = take_transform(reader))
            normal.pattern.placed = *m * normal.pattern.placed;
        else if (reader.take("bump_size"))
            normal.amount = parse_float(reader);
        else if (reader.take("accuracy"))
            normal.accuracy = std::max(1e-6, parse_float(reader));
        else if (reader.take("no_bump_scale"))
            normal.keeps_depth = parse_flag(reader);
        else if (reader.take("slope_map"))
            normal.profile = parse_slope_map(reader);
        else if (reader.take("bump_map")) {
            pattern.forget();
            take_bump_map(reader, token, normal);
        } else if (reader.take("uv_mapping")) {
            if (parse_flag(reader))
                on_uv = token.place;
        } else if (pattern.take()) {
            if (pattern.is_pattern(token)) {
                normal.kind = bump_of(token);
                normal.profile.clear();
            }
        } else if (starts_number(reader, token))
            normal.amount = parse_float(reader);
        else if (!reader.take(','))
            reader.fail_here("a part of a normal");
    }
    pattern.finish();
    if (on_uv)
        normal.pattern.notes.push_back(uv_mapping_left_out(reader, *on_uv));
    return normal;
}

Normal parse_normal(Reader& reader, const Normal& base) {
    reader.expect('{', "normal");
    Normal normal = parse_normal_parts(reader, base, '}');
    reader.expect('}', "a normal");
    return normal;
}

} // namespace ovc::pov
