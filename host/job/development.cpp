// SPDX-License-Identifier: Apache-2.0
// Exposure scales light in every file, and tone mapping is for displays alone.
#include "host/job/development.h"

#include <fmt/format.h>

#include <utility>

namespace ovc {

/// Returns the source after change(pixels).
template <class Change>
static PixelSource changed(const PixelSource& source, Change change) {
    return {source.width, source.height,
            [read = source.read, change](size_t first, std::span<vec4> pixels) {
                read(first, pixels);
                change(pixels);
            }};
}

PixelSource light_of(const Film& film, double gamma) {
    const PixelSource light = film.pixels();
    return gamma == 1 ? light
                      : changed(light, [=](std::span<vec4> some) { to_linear(some, gamma); });
}

DevelopedImage develop(PixelSource light, const Development& how) {
    if (!how.exposure)
        return {std::move(light), std::nullopt};
    const double stops = how.exposure->is_automatic ? automatic_stops(light) : how.exposure->stops;
    return {changed(light, [=](std::span<vec4> some) { expose(some, stops); }), stops};
}

PixelSource for_display(const DevelopedImage& developed, const Development& how) {
    const ToneMap curve = how.tone_map;
    return curve == ToneMap::None
               ? developed.light
               : changed(developed.light, [=](std::span<vec4> some) { map_tones(some, curve); });
}

Result<Done> save_picture(const DevelopedImage& developed, std::span<const std::string> files,
                          const Development& how, FileContents contents) {
    if (developed.stops)
        contents.notes.push_back({"overcast:exposure", fmt::format("{:.4g}", *developed.stops)});
    Result<Done> all = Done{};
    for (const std::string& file : files) {
        const Result<Done> saved = save_image(
            takes_layers(file) ? developed.light : for_display(developed, how), file, contents);
        if (!saved && all)
            all = saved;
    }
    return all;
}

} // namespace ovc
