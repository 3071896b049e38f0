// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/parse/parse_media.h"

#include "importers/pov/parse/texture.h"
#include "importers/pov/values/transform.h"

#include <algorithm>

namespace ovc::pov {

namespace {

/// Rays through a medium are looked at in at least so many places: povray takes more samples than
/// it is asked for where they differ.
constexpr uint32_t kMinSamples = 16;
constexpr int kMaxSamples = 1 << 16;

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
bool take_how(Reader& reader, uint32_t& samples, uint32_t& intervals) {
    if (reader.take("intervals"))
        intervals = uint32_t(parse_int(reader, 1, kMaxSamples, "intervals"));
    else if (reader.take("samples")) { // MIN [, MAX]
        samples = uint32_t(parse_int(reader, 1, kMaxSamples, "samples"));
        if (reader.take(','))
            samples = std::max(samples, uint32_t(parse_int(reader, 0, kMaxSamples, "samples")));
    } else if (reader.take("method") || reader.take("confidence") || reader.take("variance") ||
               reader.take("ratio") || reader.take("jitter") || reader.take("aa_threshold") ||
               reader.take("aa_level"))
        parse_float(reader);
    else
        return false;
    return true;
}

} // namespace

Pigment parse_density(Reader& reader) {
    return parse_pigment(reader, {});
}

Media parse_media(Reader& reader) {
    const Deeper deeper(reader);
    Media media;
    uint32_t samples = 1, intervals = 1;
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
        } else if (!take_how(reader, samples, intervals) && !reader.take("collect") &&
                   !reader.take(','))
            reader.fail_here("'}' or a part of media");
    }
    const uint64_t asked_for = uint64_t(samples) * intervals;
    media.medium.samples = std::max(
        media.medium.samples, uint32_t(std::clamp<uint64_t>(asked_for, kMinSamples, 1 << 16)));
    return media;
}

} // namespace ovc::pov
