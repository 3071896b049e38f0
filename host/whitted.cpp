// SPDX-License-Identifier: Apache-2.0
// What becomes of a path at a surface.
#include "host/whitted.h"

#include <algorithm>

namespace ovc {

Children split_weight(Path& path, const Ray& ray, const SurfacePoint& surface, uint32_t max_depth) {
    const bool total = surface.material->transmission > 0 && !refracted_ray(ray, surface);
    const Branches parts = branches(surface, total);
    const vec3 whole = path.weight;
    const auto follow = [&](const vec3& share, float taken) {
        const vec3 weight = whole * share;
        if (path.depth >= max_depth || max_component(weight) < kLeastWeight)
            return vec3(0);
        path.weight -= whole * taken;
        return weight;
    };
    Children children;
    children.mirror = follow(parts.mirror, parts.taken_by_mirror);
    children.through = follow(parts.through, parts.taken_by_through);
    return children;
}

bool lets_light_through(const Scene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const Material& m) { return m.transmission > 0; }) ||
           std::any_of(scene.meshes.begin(), scene.meshes.end(),
                       [](const MeshInfo& m) { return m.no_shadow; });
}

bool pass_glass(const Scene& scene, const Light& light, const WhittedOptions& options,
                uint32_t depth, const Hit& hit, Ray& ray, vec3& left) {
    const SurfacePoint glass = surface_point(scene, ray, hit);
    if (!scene.meshes[hit.id.mesh].no_shadow) {
        left *= branches(glass, /* total= */ false).through;
        if (depth >= options.max_depth || max_component(left) < kLeastWeight)
            left = vec3(0);
    }
    const dvec3 there = ray.dir;
    ray = shadow_ray(light, glass.beyond);
    // A light that lies in the surface has been reached; going back to it might never end.
    return left != vec3(0) && glm::dot(ray.dir, there) > 0;
}

} // namespace ovc
