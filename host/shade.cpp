// SPDX-License-Identifier: Apache-2.0
// Based on: Whitted 1980, "An Improved Illumination Model for Shaded Display", with a hemisphere of
// sky for ambient light.
#include "host/shade.h"

#include <algorithm>
#include <numbers>

namespace ovc {

/// The share of the background's light that arrives as ambient light; the rest is the lamps'.
static constexpr float kSkyShare = 0.32f;
/// Light from nowhere in particular, so that shadows in a room without a sky are not black.
static constexpr float kAmbient = 0.04f;
/// How much darker than the horizon the ground below it is taken to be.
static constexpr float kGround = 0.35f;

static vec3 geometric_normal(const Triangle& t) {
    const dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    // Scaled first: the squared length of a tiny triangle's normal underflows. A hit triangle has
    // an area.
    return vec3(glm::normalize(n / max_component(glm::abs(n))));
}

static vec3 interpolated_normal(const MeshInfo& mesh, const Hit& hit, const vec3& fallback) {
    if (mesh.normals.empty())
        return fallback;
    const vec3* corner = mesh.normals.data() + size_t(hit.id.prim) * 3;
    const vec3 n =
        float(1 - hit.u - hit.v) * corner[0] + float(hit.u) * corner[1] + float(hit.v) * corner[2];
    const float length = glm::length(n);
    // Opposite or missing normals cancel out; then the plane's own has to do.
    return length > 1e-6f && std::isfinite(length) ? n / length : fallback;
}

static vec3 facing(const vec3& normal, const vec3& towards) {
    return glm::dot(normal, towards) < 0 ? -normal : normal;
}

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit) {
    static const Material kPlain;
    const MeshInfo& mesh = scene.meshes[hit.id.mesh];
    const Material& material =
        mesh.material < scene.materials.size() ? scene.materials[mesh.material] : kPlain;
    const Triangle t = scene.soup.triangle(hit.id);

    SurfacePoint s;
    const vec3 plane = geometric_normal(t);
    s.geometric_normal = glm::dot(dvec3(plane), ray.dir) > 0 ? -plane : plane;
    s.normal = facing(interpolated_normal(mesh, hit, s.geometric_normal), s.geometric_normal);
    s.color = material.color;
    s.mirror = material.mirror;

    // From the corners the position errs by a few ulp of their coordinates, however far away the
    // ray began.
    const dvec3 on_plane = (1 - hit.u - hit.v) * t[0] + hit.u * t[1] + hit.v * t[2];
    const double reach = std::max({max_component(glm::abs(t[0])), max_component(glm::abs(t[1])),
                                   max_component(glm::abs(t[2]))});
    s.position = on_plane + (0x1p-48 * reach) * dvec3(s.geometric_normal);
    return s;
}

vec3 background_color(const Background& background, const vec3& up, const dvec3& dir) {
    const float height = float(glm::dot(glm::normalize(dir), dvec3(up)));
    return glm::mix(background.horizon, background.zenith, std::clamp(height, 0.0f, 1.0f));
}

vec3 ambient_light(const Background& background, const vec3& up, const SurfacePoint& surface) {
    const vec3 ground = kGround * background.horizon;
    const vec3 sky = 0.5f * (background.horizon + background.zenith);
    const float openness = 0.5f + 0.5f * glm::dot(surface.normal, up);
    return surface.color * (kAmbient + kSkyShare * glm::mix(ground, sky, openness));
}

vec3 direct_light(const PointLight& light, const SurfacePoint& surface) {
    const vec3 towards = vec3(glm::normalize(light.position - surface.position));
    const float cosine = glm::dot(surface.normal, towards);
    if (!(cosine > 0) || !(glm::dot(surface.geometric_normal, towards) > 0))
        return vec3(0);
    return surface.color * light.color * (cosine * std::numbers::inv_pi_v<float>);
}

Ray shadow_ray(const PointLight& light, const SurfacePoint& surface) {
    return {surface.position, 0, light.position - surface.position, 1};
}

Ray mirror_ray(const Ray& ray, const SurfacePoint& surface) {
    const auto mirrored = [&](const vec3& normal) {
        const dvec3 n = glm::normalize(dvec3(normal));
        return ray.dir - 2 * glm::dot(ray.dir, n) * n;
    };
    Ray out;
    out.org = surface.position;
    out.dir = mirrored(surface.normal);
    if (glm::dot(out.dir, dvec3(surface.geometric_normal)) <= 0)
        out.dir = mirrored(surface.geometric_normal);
    return out;
}

} // namespace ovc
