// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/thrown_light.h"

#include "core/texture/pattern.h"

#include <optional>

namespace ovc {

/// Returns the width of the window by its height: those of the picture, or 1 if it is not open.
static double shape_of(const Scene& scene, uint32_t texture) {
    const std::optional<ImageTexture>& image = scene.textures[texture].image;
    const dvec2 size = image && image->lookup ? image->lookup->size() : dvec2(1);
    return size.x / size.y;
}

vec3 thrown_color(const Scene& scene, const Light& light, const dvec3& position) {
    if (!light.thrown)
        return vec3(1);
    const dvec3 from = position - light.position;
    const double distance = glm::length(from);
    if (!(distance > 0))
        return vec3(0);
    const auto& [placed, has_window] = *light.thrown;
    const dvec3 way = glm::normalize(placed.at(from / distance)); // the light may be scaled
    const auto color_of = [&](const dvec3& at) {
        return color_at(scene.textures, placed.texture, TexturePoint(at)).rgb;
    };
    if (!has_window)
        return color_of(way);
    const auto at = ThrownPicture::through_window(way, shape_of(scene, placed.texture));
    return at ? color_of(dvec3(*at, 0)) : vec3(0);
}

} // namespace ovc
