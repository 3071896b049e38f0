// SPDX-License-Identifier: Apache-2.0
// Reads light_source: points, spots, cylinders and parallel light.
#include "importers/pov/parse/parse_object.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace ovc::pov {

namespace {

double cosine_of_degrees(double degrees) {
    return std::cos(degrees * std::numbers::pi / 180);
}

/// Parts of a light that take effect once all of them are read.
struct Words {
    /// The last word that names a kind counts, as in povray.
    enum class Kind { Point, Spot, Cylinder, Shadowless };
    Kind kind = Kind::Point;
    dvec3 point_at{0, 0, 1};
    std::optional<double> radius, falloff; // degrees of a spot, a cylinder's distances
    double tightness = 0;
    ObjectPtr looks_like;
};

bool parse_light_part(Reader& reader, Words& words, Light& light) {
    if (reader.take("spotlight"))
        words.kind = Words::Kind::Spot;
    else if (reader.take("cylinder"))
        words.kind = Words::Kind::Cylinder, light.parallel = true;
    else if (reader.take("parallel"))
        light.parallel = true;
    else if (reader.take("point_at"))
        words.point_at = parse_vector(reader);
    else if (reader.take("radius"))
        words.radius = parse_float(reader);
    else if (reader.take("falloff"))
        words.falloff = parse_float(reader);
    else if (reader.take("tightness"))
        words.tightness = parse_float(reader);
    else if (reader.take("fade_distance"))
        light.fade_distance = parse_float(reader);
    else if (reader.take("fade_power"))
        light.fade_power = parse_float(reader);
    else if (reader.take("shadowless"))
        words.kind = Words::Kind::Shadowless;
    else
        return false;
    return true;
}

/// Reads `axis1, axis2, count1, count2`.
void parse_area(Reader& reader, LightSource& source) {
    for (dvec3& side : source.sides) {
        side = parse_vector(reader);
        reader.take_comma();
    }
    for (int& count : source.counts) {
        count = parse_int(reader, 1, 1 << 20, "the lights of an area_light");
        reader.take_comma();
    }
}

/// Reads `{ OBJECT }` behind a word of a light.
ObjectPtr parse_light_object(Reader& reader, std::string_view word) {
    reader.expect('{', word);
    ObjectPtr object;
    if (starts_object(reader.peek()))
        object = parse_object(reader);
    else if (const auto named = take_named_if<ObjectPtr>(reader))
        object = *named;
    else
        reader.fail_here("an object");
    auto changed = std::make_shared<Object>(*object);
    parse_modifiers(reader, *changed);
    return changed;
}

bool parse_other_part(Reader& reader, Words& words, LightSource& source) {
    if (reader.take("area_light")) {
        parse_area(reader, source);
    } else if (reader.take("looks_like")) {
        words.looks_like = parse_light_object(reader, "looks_like");
    } else if (reader.take("projected_through")) {
        source.projector = parse_light_object(reader, "projected_through");
    } else if (reader.take("photons"))
        skip_braces(reader, "photons");
    else if (reader.take("circular"))
        source.circular = true;
    else if (reader.take("orient"))
        source.orient = source.circular = true;
    else if (reader.take("area_illumination"))
        source.illuminates = parse_flag(reader);
    else if (reader.take("media_interaction"))
        source.light.lights_media = parse_flag(reader);
    else if (reader.take("jitter"))
        source.jitter = parse_flag(reader);
    else if (reader.take("media_attenuation"))
        source.light.fades_in_air = parse_flag(reader);
    else if (reader.take("adaptive"))
        parse_float(reader);
    else
        return false;
    return true;
}

/// Gives the light its cone, its beam or neither. As measured of povray 3.7.0.10, there is no light
/// beyond a radius that is larger than the falloff, a cylinder without a radius is even, and media
/// do not scatter light without shadows.
void apply_kind(const Words& words, Light& light) {
    switch (words.kind) {
    case Words::Kind::Point:
        break;
    case Words::Kind::Spot: {
        const double radius = cosine_of_degrees(words.radius.value_or(30));
        const double falloff = cosine_of_degrees(words.falloff.value_or(45));
        light.cone = SpotCone{radius, std::min(radius, falloff), words.tightness};
        break;
    }
    case Words::Kind::Cylinder: {
        const double radius = words.radius.value_or(0.75);
        const double falloff = std::max(words.falloff.value_or(1), 1e-9);
        light.beam = LightBeam{radius > 0 ? radius : falloff, falloff, words.tightness};
        break;
    }
    case Words::Kind::Shadowless:
        light.shadowless = true;
        light.lights_media = false;
    }
}

} // namespace

void parse_light_source(Reader& reader, Object& object) {
    LightSource source;
    Light& light = source.light;
    light.position = parse_vector(reader);
    reader.take_comma();
    light.color = parse_color(reader).rgb * std::numbers::pi_v<float>;
    Words words;
    dmat4 placed(1);
    while (!reader.take('}')) {
        if (parse_light_part(reader, words, light) || parse_other_part(reader, words, source))
            continue;
        if (const auto m = take_transform(reader))
            placed = *m * placed;
        else if (!reader.take(','))
            reader.fail_here("'}' or a part of light_source");
    }
    source.point_at = words.point_at;
    const dvec3 way = words.point_at - light.position;
    if (glm::length(way) > 0)
        light.direction = glm::normalize(way);
    apply_kind(words, light);
    light.clearance = 1e-3; // as povray 3.7 draws planes before a light
    if (words.looks_like) {
        auto lamp = std::make_shared<Object>(*words.looks_like);
        place(*lamp, translation(light.position));
        lamp->seen_by &= ~uint32_t(kShadowsAll);
        object.children.push_back(lamp);
    }
    object.shape = source;
    place(object, placed);
}

} // namespace ovc::pov
