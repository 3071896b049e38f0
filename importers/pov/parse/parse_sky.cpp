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

} // namespace ovc::pov
