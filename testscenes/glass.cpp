// SPDX-License-Identifier: Apache-2.0
// glass, a clear ball and a mirror ball over a checked floor: what Whitted 1980 showed.
#include "testscenes/scenes.h"
#include "testscenes/sphere.h"

namespace ovc {

namespace {

constexpr uint32_t kLevel = 5; // 20,480 triangles a ball
constexpr int kSquares = 8;    // to each side of the middle

void add_ball(Scene& scene, Material material, dvec3 center) {
    Corners corners = make_sphere(kLevel);
    // The unit sphere is its own normals: light is bent as by a sphere, not by facets.
    std::vector<vec3> normals;
    for (const vec3& corner : corners)
        normals.push_back(glm::normalize(corner));
    const std::string name = material.name;
    scene.materials.push_back(std::move(material));
    scene.add_mesh(name, uint32_t(scene.materials.size() - 1),
                   Chunk::owning(center, std::move(corners)), std::move(normals));
}

void add_floor(Scene& scene) {
    Corners squares[2];
    for (int i = -kSquares; i < kSquares; ++i)
        for (int j = -kSquares; j < kSquares; ++j)
            add_quad(squares[(i + j) & 1], {i, 0, j}, {i, 0, j + 1}, {i + 1, 0, j + 1},
                     {i + 1, 0, j});
    scene.materials.push_back({"ivory", vec3(0.85f, 0.82f, 0.72f), 0});
    scene.materials.push_back({"slate", vec3(0.12f, 0.16f, 0.22f), 0});
    for (uint32_t color = 0; color < 2; ++color)
        scene.add_mesh("floor", color, Chunk::owning(dvec3(0), std::move(squares[color])));
}

} // namespace

Scene make_glass() {
    Scene scene;
    add_floor(scene);
    add_ball(scene, {"glass", vec3(0), 0.08f, 0.9f, {0.93f, 1, 0.96f}, 1.5}, {-0.7, 1.1, 0.6});
    add_ball(scene, {"mirror", vec3(0.3f), 0.85f}, {1.3, 1, -1.2});
    scene.lights.push_back({dvec3(-4, 7, 5), vec3(2.6f)});
    scene.camera = Camera{dvec3(0, 2.2, 7), dvec3(0.2, 0.8, 0), dvec3(0, 1, 0), 38};
    return scene;
}

} // namespace ovc
