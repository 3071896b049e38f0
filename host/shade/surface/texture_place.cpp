// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/texture_place.h"

#include <algorithm>
#include <cmath>

namespace ovc {

/// A cone that meets the surface at a grazing angle is taken as no longer than this many widths.
static constexpr double kMaxStretch = 32;

/// Returns the sides of the part of the surface's plane within the cone: along the view, where it
/// is stretched, and across.
static std::array<dvec3, 2> sides_of(double width, const SurfacePoint& surface) {
    const dvec3& n = surface.geometric_normal;
    const double cosine = std::abs(glm::dot(n, surface.view));
    const dvec3 along = surface.view - glm::dot(surface.view, n) * n;
    const double length = glm::length(along);
    const dvec3 other = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 direction = length > 1e-9 ? along / length : glm::normalize(glm::cross(n, other));
    return {width / std::max(cosine, 1 / kMaxStretch) * direction,
            width * glm::cross(n, direction)};
}

/// Returns how a point of the triangle moves by u and by v; zeros where the texture coordinates of
/// the corners lie on a line.
static std::array<dvec3, 2> by_uv(const Triangle& t, const std::array<vec2, 3>& uv) {
    const dvec2 b = dvec2(uv[1]) - dvec2(uv[0]), c = dvec2(uv[2]) - dvec2(uv[0]);
    const double area = b.x * c.y - b.y * c.x;
    if (!(std::abs(area) > 0) || !std::isfinite(area))
        return {};
    const dvec3 to_b = t[1] - t[0], to_c = t[2] - t[0];
    return {(c.y * to_b - b.y * to_c) / area, (b.x * to_c - c.x * to_b) / area};
}

/// Returns how u and v change over a step in the triangle's plane.
static dvec2 uv_step(const Triangle& t, const std::array<vec2, 3>& uv, const dvec3& step) {
    // The step's weights of the sides to the corners b and c, by the normal equations.
    const dvec3 b = t[1] - t[0], c = t[2] - t[0];
    const double bb = glm::dot(b, b), bc = glm::dot(b, c), cc = glm::dot(c, c);
    const double area = bb * cc - bc * bc;
    if (!(area > 0))
        return dvec2(0);
    const double sb = glm::dot(step, b), sc = glm::dot(step, c);
    return (sb * cc - sc * bc) / area * (dvec2(uv[1]) - dvec2(uv[0])) +
           (sc * bb - sb * bc) / area * (dvec2(uv[2]) - dvec2(uv[0]));
}

void take_texture_place(const Scene& scene, const MeshInfo& mesh, const Triangle& triangle,
                        const Hit& hit, double width, const SurfacePoint& surface,
                        TexturePoint& point) {
    if (width > 0)
        point.sides = sides_of(width, surface);
    const PerCorner<vec2> all = scene.uv_of(mesh);
    if (all.empty())
        return;
    const std::array<vec2, 3> uv = all.of(hit.id.prim);
    point.has_uv = true;
    point.uv = (1 - hit.u - hit.v) * dvec2(uv[0]) + hit.u * dvec2(uv[1]) + hit.v * dvec2(uv[2]);
    point.by_uv = by_uv(triangle, uv);
    for (size_t i = 0; i < 2 && width > 0; ++i)
        point.uv_sides[i] = uv_step(triangle, uv, point.sides[i]);
}

} // namespace ovc
