// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_sky.h"

#include "importers/pov/parse/pattern_map.h"
#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

#include <algorithm>

namespace ovc::pov {

SkySphere parse_sky_sphere(Reader& reader) {
    SkySphere sky;
    reader.expect('{', "sky_sphere");
    while (!reader.take('}')) {
        if (const auto named_sky = take_named_if<SkySphere>(reader))
            sky = *named_sky;
        else if (reader.take("pigment"))
            sky.pigments.push_back(parse_pigment(reader, {}));
        else if (const auto m = take_transform(reader)) {
            for (Pigment& pigment : sky.pigments)
                pigment.placed = *m * pigment.placed;
        } else if (const Token token = reader.peek(); reader.take("emission")) {
            parse_color(reader);
            reader.omit("sky emission", token.place, "emission of a sky_sphere is left out");
        } else
            reader.fail_here("a pigment of sky_sphere");
    }
    return sky;
}

Fog parse_fog(Reader& reader) {
    Fog fog;
    fog.noise = reader.noise_kind();
    reader.has_media = true;
    bool on_ground = false;
    reader.expect('{', "fog");
    while (!reader.take('}')) {
        const Token token = reader.peek();
        if (const auto named_fog = take_named_if<Fog>(reader))
            fog = *named_fog, on_ground = fog.altitude > 0;
        else if (reader.take("fog_type"))
            on_ground = parse_int(reader, 1, 2, "fog_type") == 2;
        else if (reader.take("distance"))
            fog.distance = parse_float(reader);
        else if (reader.take("fog_offset"))
            fog.offset = parse_float(reader);
        else if (reader.take("fog_alt"))
            fog.altitude = parse_float(reader);
        else if (reader.take("up"))
            fog.up = parse_vector(reader);
        else if (reader.take("turbulence"))
            fog.turbulence = parse_vector(reader);
        else if (reader.take("turb_depth"))
            fog.turbulence_depth = parse_float(reader);
        else if (reader.take("octaves"))
            fog.octaves.count = uint64_t(std::clamp(parse_float(reader), 1.0, double(kMaxOctaves)));
        else if (reader.take("lambda"))
            fog.octaves.lambda = parse_float(reader);
        else if (reader.take("omega"))
            fog.octaves.omega = parse_float(reader);
        else if (const auto m = take_transform(reader))
            fog.up = dvec3(*m * dvec4(fog.up, 0));
        else if (starts_color(token) || starts_number(reader, token))
            fog.color = parse_color(reader);
        else if (!reader.take(','))
            reader.fail_here("'}' or a part of fog");
    }
    if (!on_ground)
        fog.altitude = 0;
    else if (!(fog.altitude > 0))
        fog.altitude = 1e-9; // no fog above the offset
    const double length = glm::length(fog.up);
    fog.up = length > 0 ? fog.up / length : dvec3(0, 1, 0);
    return fog;
}

Rainbow parse_rainbow(Reader& reader) {
    Rainbow bow;
    reader.has_media = true;
    reader.expect('{', "rainbow");
    while (!reader.take('}')) {
        if (const auto named_bow = take_named_if<Rainbow>(reader))
            bow = *named_bow;
        else if (reader.take("direction"))
            bow.direction = parse_vector(reader);
        else if (reader.take("up"))
            bow.up = parse_vector(reader);
        else if (reader.take("angle"))
            bow.angle = parse_float(reader);
        else if (reader.take("width"))
            bow.width = parse_float(reader);
        else if (reader.take("distance"))
            bow.distance = parse_float(reader);
        else if (reader.take("arc_angle"))
            bow.arc = parse_float(reader);
        else if (reader.take("falloff_angle"))
            bow.full_arc = parse_float(reader);
        else if (reader.take("jitter"))
            bow.jitter = parse_float(reader);
        else if (reader.take("color_map") || reader.take("colour_map")) {
            bow.colors.clear();
            for (const MapStop& stop : parse_map(reader, MapOf::Pigments).stops)
                bow.colors.push_back({stop.at, stop.pigment.color, kNoTexture});
            std::ranges::stable_sort(bow.colors, {}, &TextureStop::at);
        } else if (const auto m = take_transform(reader)) {
            bow.direction = dvec3(*m * dvec4(bow.direction, 0));
            bow.up = dvec3(*m * dvec4(bow.up, 0));
        } else if (!reader.take(','))
            reader.fail_here("'}' or a part of rainbow");
    }
    return bow;
}

} // namespace ovc::pov
