// SPDX-License-Identifier: Apache-2.0
// box: a small room with one open side and two blocks, 32 triangles; after the Cornell box.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

namespace ovc {

namespace {

void add_material_mesh(Scene& scene, const char* name, vec3 color, float mirror, Corners corners) {
    scene.materials.push_back({name, color, mirror});
    scene.add_mesh(name, uint32_t(scene.materials.size() - 1),
                   Chunk::owning(dvec3(0), std::move(corners)));
}

/// A block with a square foot, turned about the vertical; its bottom is left open.
Corners block(dvec3 foot, double width, double height, double turns) {
    const auto corner = [&](int i, double y) {
        const dvec2 c = 0.7071067811865476 * width * circle(turns + 0.25 * i);
        return foot + dvec3(c.x, y, c.y);
    };
    Corners corners;
    for (int i = 0; i < 4; ++i)
        add_quad(corners, corner(i, 0), corner(i, height), corner(i + 1, height), corner(i + 1, 0));
    add_quad(corners, corner(3, height), corner(2, height), corner(1, height), corner(0, height));
    return corners;
}

} // namespace

Scene make_box() {
    Scene scene;
    Corners white, red, green;
    add_quad(white, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    add_quad(white, {-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1});
    add_quad(white, {-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
    add_quad(red, {-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1});
    add_quad(green, {1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1});
    add_material_mesh(scene, "white", vec3(0.73f, 0.72f, 0.68f), 0, std::move(white));
    add_material_mesh(scene, "red", vec3(0.6f, 0.06f, 0.05f), 0, std::move(red));
    add_material_mesh(scene, "green", vec3(0.12f, 0.45f, 0.1f), 0, std::move(green));
    add_material_mesh(scene, "short block", vec3(0.7f), 0, block({0.35, 0, 0.3}, 0.58, 0.58, 0.08));
    add_material_mesh(scene, "tall block", vec3(0.3f), 0.7f,
                      block({-0.32, 0, -0.32}, 0.58, 1.2, 0.2));
    scene.lights.push_back({dvec3(0, 1.9, 0.1), vec3(2.6f, 2.3f, 1.8f)});
    scene.camera = Camera{dvec3(0, 1, 4.2), dvec3(0, 1, 0), dvec3(0, 1, 0), 38};
    scene.background = {vec3(0), vec3(0)};
    return scene;
}

} // namespace ovc
