// SPDX-License-Identifier: Apache-2.0
// sphere-N, an icosphere for tests of closed meshes; mirrors, spheres that see themselves in each
// other.
#include "testscenes/scenes.h"
#include "testscenes/sphere.h"

namespace ovc {

namespace {

void add_ball(Scene& scene, const char* name, dvec3 center, float radius, vec3 color,
              float mirror) {
    Corners corners = make_sphere(5);
    for (vec3& corner : corners)
        corner *= radius;
    scene.materials.push_back({name, color, mirror});
    scene.add_mesh(name, uint32_t(scene.materials.size() - 1),
                   Chunk::owning(center, std::move(corners)));
}

} // namespace

Scene make_sphere_scene(uint32_t level) {
    Scene scene;
    scene.materials.push_back({"clay", vec3(0.75f, 0.62f, 0.5f), 0});
    scene.add_mesh("sphere", 0, Chunk::owning(dvec3(0), make_sphere(level)));
    scene.lights.push_back({dvec3(-4, 6, 5), vec3(3)});
    scene.camera = Camera{dvec3(0, 1, 4), dvec3(0), dvec3(0, 1, 0), 40};
    return scene;
}

Scene make_mirrors() {
    Scene scene;
    Corners floor;
    add_quad(floor, dvec3(-9, 0, -9), dvec3(-9, 0, 9), dvec3(9, 0, 9), dvec3(9, 0, -9));
    scene.materials.push_back({"floor", vec3(0.3f, 0.3f, 0.32f), 0.35f});
    scene.add_mesh("floor", 0, Chunk::owning(dvec3(0), std::move(floor)));
    add_ball(scene, "chrome", {-1.3, 1, 0}, 1.0f, vec3(0.6f), 0.85f);
    add_ball(scene, "red", {1.1, 0.8, 0.6}, 0.8f, vec3(0.7f, 0.08f, 0.05f), 0.15f);
    add_ball(scene, "gold", {0.3, 0.5, 2.0}, 0.5f, vec3(0.8f, 0.55f, 0.15f), 0.5f);
    add_ball(scene, "blue", {0.6, 1.1, -2.2}, 1.1f, vec3(0.08f, 0.2f, 0.6f), 0.1f);
    scene.lights.push_back({dvec3(-5, 8, 6), vec3(2.4f, 2.2f, 2.0f)});
    scene.lights.push_back({dvec3(6, 5, 2), vec3(0.8f, 0.9f, 1.1f)});
    scene.camera = Camera{dvec3(0, 2.4, 7.5), dvec3(0, 0.7, 0), dvec3(0, 1, 0), 36};
    return scene;
}

} // namespace ovc
