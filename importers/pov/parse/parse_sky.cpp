// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_sky.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"
#include "importers/pov/words/block.h"

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
        else if (const auto m = take_transform(reader))
            fog.up = dvec3(*m * dvec4(fog.up, 0));
        else if (starts_color(token) || starts_number(reader, token))
            fog.color = parse_color(reader);
        else if (token.kind == TokenKind::Name && token.name->is_keyword) {
            reader.next();
            reader.omit("fog " + token.name->text, token.place,
                        token.name->text + " of a fog is left out");
            skip_arguments(reader);
        } else if (!reader.take(','))
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

} // namespace ovc::pov
