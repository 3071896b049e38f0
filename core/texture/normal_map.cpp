// SPDX-License-Identifier: Apache-2.0
// Heights tilt normals as in Blinn 1978, "Simulation of Wrinkled Surfaces", by the slope of the
// height along the surface.
#include "core/texture/normal_map.h"

#include "core/texture/pattern.h"

#include <algorithm>
#include <cmath>

namespace ovc {

namespace {

/// Heights are compared at least so far apart, as a share of the picture. pbrt takes the same.
constexpr double kMinStep = 0.0005;

/// The width of a texel where a texture is no picture.
constexpr double kTexel = 1 / 512.0;

dvec3 unit_or(const dvec3& v, const dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : otherwise;
}

/// Returns the length in the world of a texel of the texture, along u.
double texel_length(const Texture& texture, const dvec3& by_u) {
    const bool is_open = texture.image && texture.image->lookup;
    return glm::length(by_u) * (is_open ? 1 / texture.image->lookup->size().x : kTexel);
}

/// Returns how the height grows when the point moves by `step` along u (axis 0) or v, over the
/// step.
double slope(std::span<const Texture> textures, uint32_t texture, const TexturePoint& point,
             int axis, double step) {
    TexturePoint before = point, behind = point;
    before.uv[axis] -= 0.5 * step;
    behind.uv[axis] += 0.5 * step;
    before.at -= 0.5 * step * point.by_uv[size_t(axis)];
    behind.at += 0.5 * step * point.by_uv[size_t(axis)];
    return (height_at(textures, texture, behind) - height_at(textures, texture, before)) / step;
}

dvec3 raised(std::span<const Texture> textures, const NormalMap& map, const TexturePoint& point,
             const dvec3& normal) {
    // The dual vectors of by_uv in the surface: the gradients of u and of v.
    const dvec3 across = glm::cross(point.by_uv[0], point.by_uv[1]);
    const double area = glm::dot(across, across);
    if (!(area > 0))
        return normal;
    const std::array<dvec3, 2> gradients{glm::cross(point.by_uv[1], across) / area,
                                         glm::cross(across, point.by_uv[0]) / area};
    double scale = map.scale;
    if (map.kind == NormalMap::Kind::Texels)
        scale *= texel_length(textures[map.texture], point.by_uv[0]);
    dvec3 sum = normal;
    for (int axis = 0; axis < 2; ++axis) {
        const double reach =
            std::max(std::abs(point.uv_sides[0][axis]), std::abs(point.uv_sides[1][axis]));
        const double step = std::max(0.5 * reach, kMinStep);
        sum -= scale * slope(textures, map.texture, point, axis, step) * gradients[size_t(axis)];
    }
    return sum;
}

/// The width of a place in space without a footprint.
constexpr double kPlace = 1e-4;

dvec3 raised_in_space(std::span<const Texture> textures, const NormalMap& map,
                      const TexturePoint& point, const dvec3& normal) {
    const double reach = std::max(glm::length(point.sides[0]), glm::length(point.sides[1]));
    const double step = reach > 0 ? 0.5 * reach : kPlace;
    const int other = major_axis(dvec3(1) - glm::abs(normal));
    dvec3 across(0);
    across[other] = 1;
    const dvec3 tangent = glm::normalize(glm::cross(normal, across));
    dvec3 sum = normal;
    for (const dvec3& way : {tangent, glm::cross(normal, tangent)}) {
        TexturePoint before = point, behind = point;
        before.at -= 0.5 * step * way;
        behind.at += 0.5 * step * way;
        const double rise =
            height_at(textures, map.texture, behind) - height_at(textures, map.texture, before);
        sum -= map.scale * rise / step * way;
    }
    return sum;
}

dvec3 of_tangent_space(std::span<const Texture> textures, const NormalMap& map,
                       const TexturePoint& point, const dvec3& normal) {
    const vec3 color = color_at(textures, map.texture, point).rgb;
    const dvec3 n = 2.0 * dvec3(color) - 1.0;
    const dvec3& by_u = point.by_uv[0];
    const dvec3 tangent = unit_or(by_u - glm::dot(by_u, normal) * normal, dvec3(0));
    const dvec3 other = glm::cross(normal, tangent);
    const dvec3 bitangent = glm::dot(other, point.by_uv[1]) < 0 ? -other : other;
    return map.scale * (n.x * tangent + n.y * bitangent) + std::max(n.z, 0.0) * normal;
}

} // namespace

dvec3 tilted(std::span<const Texture> textures, const NormalMap& map, const TexturePoint& point,
             const dvec3& normal) {
    if (map.kind == NormalMap::Kind::Space)
        return unit_or(raised_in_space(textures, map, point, normal), normal);
    if (!point.has_uv)
        return normal;
    return unit_or(map.kind == NormalMap::Kind::Tangent
                       ? of_tangent_space(textures, map, point, normal)
                       : raised(textures, map, point, normal),
                   normal);
}

} // namespace ovc
