// SPDX-License-Identifier: Apache-2.0
#include "host/shade/lights/thrown_light.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ovc {

/// Ways that lie flatter than this before the light's window go through none.
static constexpr double kMinAhead = 1e-3;

/// Returns the width of the window by its height: those of the picture, or 1 if it is not open.
static double shape_of(const Scene& scene, uint32_t texture) {
    const std::optional<ImageTexture>& image = scene.textures[texture].image;
    const dvec2 size = image && image->lookup ? image->lookup->size() : dvec2(1);
    return size.x / size.y;
}

/// Returns where the way goes through the window, from 0 to 1; nothing if it goes by it.
static std::optional<dvec3> in_window(const dvec3& way, double shape) {
    if (!(way.z >= kMinAhead))
        return std::nullopt;
    const dvec2 at = dvec2(way) / way.z / glm::max(dvec2(shape, 1 / shape), 1.0);
    if (!(std::abs(at.x) <= 1 && std::abs(at.y) <= 1))
        return std::nullopt;
    return dvec3(0.5 * (at + 1.0), 0);
}

vec3 thrown_color(const Scene& scene, const Light& light, const dvec3& position) {
    if (!light.thrown)
        return vec3(1);
    const dvec3 from = position - light.position;
    const double distance = glm::length(from);
    if (!(distance > 0))
        return vec3(0);
    const auto& [placed, has_window] = *light.thrown;
    const dvec3 way = placed.at(from / distance);
    const auto at = has_window ? in_window(way, shape_of(scene, placed.texture))
                               : std::optional(glm::normalize(way));
    return at ? color_at(scene.textures, placed.texture, TexturePoint(*at)).rgb : vec3(0);
}

} // namespace ovc
