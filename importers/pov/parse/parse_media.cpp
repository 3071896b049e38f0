// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_media.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"

#include <algorithm>

namespace ovc::pov {

namespace {

constexpr int kMaxSamples = 1 << 16;

/// The closeness with which a scene asks to look at a medium, with povray's defaults.
struct Closeness {
    int method = 3, samples = 10, level = 3;
};

/// Reads `{ KIND, COLOR [eccentricity E] [extinction X] }`.
void parse_scattering(Reader& reader, Medium& medium) {
    reader.expect('{', "scattering");
    static_assert(int(Medium::Phase::HenyeyGreenstein) == 4);
    medium.phase = Medium::Phase(parse_int(reader, 1, 5, "the kind of scattering") - 1);
    reader.take_comma();
    medium.scattering = parse_color(reader).rgb;
    while (!reader.take('}')) {
        if (reader.take("eccentricity"))
            medium.eccentricity = std::clamp(float(parse_float(reader)), -0.999f, 0.999f);
        else if (reader.take("extinction"))
            medium.extinction = float(parse_float(reader));
        else if (!reader.take(','))
            reader.fail_here("'}' or a part of scattering");
    }
}

/// Takes a word that says how exactly povray is to compute it.
bool take_how(Reader& reader, Closeness& how, Medium& medium) {
    if (reader.take("intervals"))
        medium.intervals = uint32_t(parse_int(reader, 1, kMaxSamples, "intervals"));
    else if (reader.take("samples")) { // MIN [, MAX]
        how.samples = parse_int(reader, 1, kMaxSamples, "samples");
        if (reader.take(','))
            parse_int(reader, 0, kMaxSamples, "samples");
    } else if (reader.take("method"))
        how.method = parse_int(reader, 1, 3, "the method of media");
    else if (reader.take("aa_threshold"))
        medium.threshold = float(parse_float(reader));
    else if (reader.take("aa_level"))
        how.level = parse_int(reader, 1, int(kMaxMediumLevels), "aa_level");
    else if (reader.take("confidence") || reader.take("variance") || reader.take("ratio") ||
             reader.take("jitter"))
        parse_float(reader);
    else
        return false;
    return true;
}

/// Tells the medium how closely to look. Measured: povray's method 3 takes half as many parts as
/// samples, and one more.
void apply(const Closeness& how, Medium& medium) {
    const bool halves = how.method == 3;
    medium.samples = uint32_t(halves ? std::max(how.samples, 3) / 2 + 1 : how.samples);
    medium.levels = halves ? uint32_t(how.level) : 0;
}

} // namespace

Pigment parse_density(Reader& reader) {
    return parse_pigment(reader, {});
}

Media parse_media(Reader& reader) {
    const Deeper deeper(reader);
    reader.has_media = true;
    Media media;
    Closeness how;
    bool told = false;
    reader.expect('{', "media");
    while (!reader.take('}')) {
        if (const auto other = take_named_if<Media>(reader))
            media = *other;
        else if (reader.take("absorption"))
            media.medium.absorption = parse_color(reader).rgb;
        else if (reader.take("emission"))
            media.medium.emission = parse_color(reader).rgb;
        else if (reader.take("scattering"))
            parse_scattering(reader, media.medium);
        else if (reader.take("density"))
            media.densities.push_back(parse_density(reader));
        else if (const auto m = take_transform(reader)) {
            for (Pigment& density : media.densities)
                density.placed = *m * density.placed;
        } else if (take_how(reader, how, media.medium))
            told = true;
        else if (!reader.take("collect") && !reader.take(','))
            reader.fail_here("'}' or a part of media");
    }
    if (told) // else as the medium that it is a copy of
        apply(how, media.medium);
    return media;
}

} // namespace ovc::pov
