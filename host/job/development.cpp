// SPDX-License-Identifier: Apache-2.0
// Exposure scales light in every file, and tone mapping is for displays alone.
#include "host/job/development.h"

#include <fmt/format.h>

#include <utility>

namespace ovc {

Image light_of(const Film& film, double gamma) {
    Image image = film.image();
    if (gamma != 1)
        to_linear(image, gamma);
    return image;
}

DevelopedImage develop(Image light, const Development& how) {
    DevelopedImage developed{std::move(light), std::nullopt};
    if (how.exposure) {
        developed.stops =
            how.exposure->is_automatic ? automatic_stops(developed.light) : how.exposure->stops;
        expose(developed.light, *developed.stops);
    }
    return developed;
}

Image for_display(const DevelopedImage& developed, const Development& how) {
    Image image = developed.light;
    map_tones(image, how.tone_map);
    return image;
}

Result<Done> save_picture(const DevelopedImage& developed, std::span<const std::string> files,
                          const Development& how, FileContents contents) {
    if (developed.stops)
        contents.notes.push_back({"overcast:exposure", fmt::format("{:.4g}", *developed.stops)});
    Result<Done> all = Done{};
    Image tones;
    for (const std::string& file : files) {
        const bool is_mapped = how.tone_map != ToneMap::None && !takes_layers(file);
        if (is_mapped && tones.pixels.empty())
            tones = for_display(developed, how);
        const Result<Done> saved = save_image(is_mapped ? tones : developed.light, file, contents);
        if (!saved && all)
            all = saved;
    }
    return all;
}

} // namespace ovc
