// SPDX-License-Identifier: Apache-2.0
// terrain-N: a square of hills over N x N cells, two triangles each.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

#include "core/system/parallel.h"

namespace ovc {

Scene make_terrain(uint32_t cells) {
    const size_t width = size_t(cells) + 1;
    std::vector<vec3> points(width * width);
    parallel_for(width, 8, [&](size_t first, size_t last) {
        for (size_t row = first; row < last; ++row)
            for (size_t column = 0; column < width; ++column) {
                const dvec2 at(double(column) / cells, double(row) / cells);
                const double height = 0.2 * fractal_noise(at * 4.0, 8, 71);
                points[row * width + column] = vec3(dvec3(at.x - 0.5, height, at.y - 0.5));
            }
    });
    Corners corners(size_t(cells) * cells * 6);
    parallel_for(cells, 8, [&](size_t first, size_t last) {
        vec3* out = corners.data() + first * cells * 6;
        for (size_t row = first; row < last; ++row)
            for (size_t column = 0; column < cells; ++column) {
                const vec3* a = &points[row * width + column]; // a d
                const vec3* b = a + width;                     // b c
                for (const vec3& corner : {a[0], b[0], b[1], a[0], b[1], a[1]})
                    *out++ = corner;
            }
    });
    Scene scene;
    scene.materials.push_back({"ground", vec3(0.42f, 0.38f, 0.28f), 0});
    scene.add_mesh("ground", 0, Chunk::owning(dvec3(0), std::move(corners)));
    scene.lights.push_back({dvec3(-4, 3, 1), vec3(4.0f, 3.5f, 2.8f)});
    scene.camera = Camera{dvec3(0.1, 0.34, 0.85), dvec3(0, -0.04, 0), dvec3(0, 1, 0), 40};
    return scene;
}

} // namespace ovc
