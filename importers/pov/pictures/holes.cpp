// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/pictures/holes.h"

#include <algorithm>
#include <cmath>

namespace ovc::pov {

/// Returns the share of light that goes through a pixel, without what all of the picture lets
/// through. The tint of a filter is lost: what a hole lets through keeps its color.
static double through(const Picture& picture, size_t pixel, const MapTransparency& transparency,
                      const dvec3& color) {
    double share = 1 - picture.pixels[pixel][3] / 65535.0;
    if (!picture.indices.empty())
        if (const auto at = transparency.of_index.find(picture.indices[pixel]);
            at != transparency.of_index.end())
            share += double(at->second.transmit) +
                     double(at->second.filter) * (color.x + color.y + color.z) / 3;
    return std::clamp(share, 0.0, 1.0);
}

HolesPtr holes_of(const Picture& picture, const MapTransparency& transparency, bool smooth,
                  const std::array<double, 256>& light) {
    auto holes = std::make_shared<Holes>();
    Cutout& cutout = holes->cutout;
    cutout.width = picture.width;
    cutout.height = picture.height;
    cutout.smooth = smooth;
    cutout.beyond = transparency.once ? Cutout::Beyond::Hole : Cutout::Beyond::Repeat;
    cutout.opacity.reserve(picture.size());
    dvec3 sum(0), first(-1);
    double weights = 0;
    holes->one_color = true;
    for (size_t i = 0; i < picture.size(); ++i) {
        const auto& pixel = picture.pixels[i];
        const dvec3 color(light[pixel[0] >> 8], light[pixel[1] >> 8], light[pixel[2] >> 8]);
        const double opacity = 1 - through(picture, i, transparency, color);
        cutout.opacity.push_back(uint8_t(std::lround(255 * opacity)));
        if (opacity > 0) {
            first = first.x < 0 ? color : first;
            holes->one_color = holes->one_color && color == first;
        }
        sum += opacity * color;
        weights += opacity;
    }
    const auto [min, max] = std::ranges::minmax(cutout.opacity);
    if (min == max && !transparency.once)
        return nullptr;
    holes->color.rgb = weights > 0 ? vec3(sum / weights) : vec3(0);
    holes->color.filter = transparency.all.filter;
    holes->color.transmit = transparency.all.transmit;
    return holes;
}

} // namespace ovc::pov
