// SPDX-License-Identifier: Apache-2.0
// Exposure scales light in every file, and tone mapping is for displays alone.
#include "host/render/development.h"

#include "core/scene.h"

#include <fmt/format.h>

#include <utility>

namespace ovc {

/// Converts the light of a scene with an assumed_gamma to the linear light that files hold.
static void to_linear(Image& image, double gamma) {
    for (vec4& pixel : image.pixels)
        for (int i = 0; i < 3; ++i)
            pixel[i] = linear_light(pixel[i], gamma);
}

DevelopedImage develop(const Film& film, double gamma, const Development& how) {
    DevelopedImage developed{film.image(), std::nullopt};
    if (gamma != 1)
        to_linear(developed.light, gamma);
    if (how.exposure) {
        developed.stops =
            how.exposure->is_automatic ? automatic_stops(developed.light) : how.exposure->stops;
        expose(developed.light, *developed.stops);
    }
    return developed;
}

Result<Done> save_picture(const DevelopedImage& developed, std::span<const std::string> files,
                          const Development& how, FileContents contents) {
    if (developed.stops)
        contents.notes.push_back({"overcast:exposure", fmt::format("{:.4g}", *developed.stops)});
    Result<Done> all = Done{};
    Image for_displays;
    for (const std::string& file : files) {
        const bool is_mapped = how.tone_map != ToneMap::None && !takes_layers(file);
        if (is_mapped && for_displays.pixels.empty()) {
            for_displays = developed.light;
            map_tones(for_displays, how.tone_map);
        }
        const Result<Done> saved =
            save_image(is_mapped ? for_displays : developed.light, file, contents);
        if (!saved && all)
            all = saved;
    }
    return all;
}

} // namespace ovc
