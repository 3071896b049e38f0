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
        else if (take_transform(reader))
            ; // a sky of one color looks the same in all directions
        else if (const Token token = reader.peek(); reader.take("emission")) {
            parse_color(reader);
            reader.warn("sky emission", token.place, "emission of a sky_sphere is left out");
        } else
            reader.fail_here("a pigment of sky_sphere");
    }
    return sky;
}

Background background_of(Reader& reader, const SkySphere& sky, const vec3& behind,
                         const Place& at) {
    Background background{behind, behind};
    for (const Pigment& pigment : sky.pigments) {
        const Color& color = pigment.color;
        const vec3 through = color.filter * color.rgb + vec3(color.transmit);
        const vec3 seen = color.opacity() * color.rgb + through * background.horizon;
        const bool is_plain = pigment.notes.empty() && !pigment.other;
        if (!is_plain)
            reader.warn("sky_sphere", at, "sky_sphere is drawn by its average color");
        background = {seen, seen};
    }
    return background;
}

} // namespace ovc::pov
