// SPDX-License-Identifier: Apache-2.0
// cloth: a banner that hangs from a pole and waves in the wind, whose corners all move. The clock's
// last moment is its first again.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

#include "core/system/parallel.h"

namespace ovc {
namespace {

constexpr uint32_t kClothCells = 256; // a side: 2 x 256 x 256 triangles

/// Returns where the cloth is that is (u, v) from its upper left corner, each from 0 to 1.
dvec3 cloth_at(double u, double v, double clock) {
    const double slack = v * (1.2 - 0.2 * v); // none at the pole
    const double wave = circle(1.5 * u + 0.6 * v - clock).y +
                        0.4 * circle(2.5 * v - 0.5 * u - 2 * clock).y +
                        0.15 * circle(5 * u + 3 * v - 3 * clock).y;
    return {3 * (u - 0.5) + 0.08 * slack * circle(u + v - clock).x,
            2.4 - 2.1 * v + 0.06 * slack * wave, 0.3 * slack * wave};
}

vec3 normal_at(double u, double v, double clock) {
    constexpr double kStep = 1e-4;
    const dvec3 along_u = cloth_at(u + kStep, v, clock) - cloth_at(u - kStep, v, clock);
    const dvec3 along_v = cloth_at(u, v + kStep, clock) - cloth_at(u, v - kStep, clock);
    return vec3(glm::normalize(glm::cross(along_v, along_u)));
}

Corners ground() {
    Corners out;
    add_quad(out, {-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9});
    return out;
}

Corners pole() {
    Corners out;
    constexpr double r = 0.03, y = 2.4, x = 1.7;
    add_quad(out, {-x, y - r, r}, {x, y - r, r}, {x, y + r, r}, {-x, y + r, r});
    add_quad(out, {-x, y + r, r}, {x, y + r, r}, {x, y + r, -r}, {-x, y + r, -r});
    add_quad(out, {-x, y + r, -r}, {x, y + r, -r}, {x, y - r, -r}, {-x, y - r, -r});
    add_quad(out, {-x, y - r, -r}, {x, y - r, -r}, {x, y - r, r}, {-x, y - r, r});
    return out;
}

} // namespace

Scene make_cloth(double clock) {
    constexpr uint32_t kWidth = kClothCells + 1;
    std::vector<vec3> points(kWidth * kWidth), directions(kWidth * kWidth);
    parallel_for(points.size(), 1024, [&](size_t first, size_t last) {
        for (size_t p = first; p < last; ++p) {
            const double u = double(p % kWidth) / kClothCells, v = double(p / kWidth) / kClothCells;
            points[p] = vec3(cloth_at(u, v, clock));
            directions[p] = normal_at(u, v, clock);
        }
    });
    Corners corners;
    std::vector<vec3> normals;
    const auto add = [&](uint32_t i, uint32_t j) {
        corners.push_back(points[j * kWidth + i]);
        normals.push_back(directions[j * kWidth + i]);
    };
    for (uint32_t j = 0; j < kClothCells; ++j)
        for (uint32_t i = 0; i < kClothCells; ++i) {
            add(i, j), add(i, j + 1), add(i + 1, j + 1);
            add(i, j), add(i + 1, j + 1), add(i + 1, j);
        }
    Scene scene;
    scene.moves = true;
    scene.materials = {{"cloth", vec3(0.72f, 0.16f, 0.12f)},
                       {"wood", vec3(0.4f, 0.3f, 0.2f)},
                       {"ground", vec3(0.55f, 0.56f, 0.5f)}};
    scene.add_mesh("cloth", 0, Chunk::owning(dvec3(0), std::move(corners)), std::move(normals));
    scene.add_mesh("pole", 1, Chunk::owning(dvec3(0), pole()));
    scene.add_mesh("ground", 2, Chunk::owning(dvec3(0), ground()));
    scene.lights.push_back({dvec3(4, 7, 6), vec3(2.8f)});
    scene.camera = Camera{dvec3(1.2, 1.7, 4.6), dvec3(0, 1.25, 0), dvec3(0, 1, 0), 44};
    return scene;
}

} // namespace ovc
