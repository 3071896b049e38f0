// SPDX-License-Identifier: Apache-2.0
// knot: a bumpy tube along a (2, 3) torus knot, closed, with as many triangles as a scanned model.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

#include "core/system/parallel.h"

namespace ovc {

namespace {

constexpr uint32_t kAlong = 2080, kAround = 210; // 2 x 2080 x 210 = 873,600 triangles

dvec3 centre_line(double turns) {
    const dvec2 twice = circle(2 * turns), thrice = circle(3 * turns);
    const double radius = 1 + 0.42 * thrice.x;
    return {radius * twice.x, 0.42 * thrice.y, radius * twice.y};
}

dvec3 point_on_tube(uint32_t along, uint32_t around) {
    const double turns = double(along) / kAlong;
    const dvec3 centre = centre_line(turns);
    const dvec3 ahead = glm::normalize(centre_line(turns + 1e-4) - centre);
    const dvec3 side = glm::normalize(glm::cross(ahead, dvec3(0, 1, 0)));
    const dvec2 c = circle(double(around) / kAround);
    const dvec3 outwards = c.x * side + c.y * glm::cross(side, ahead);
    const double scales =
        0.010 * circle(20.0 * around / kAround + 60 * turns).x * circle(200 * turns).x;
    const double bumps = 0.045 * fractal_noise(3.5 * (centre + 0.2 * outwards), 5, 81);
    return centre + (0.19 + scales + bumps) * outwards;
}

} // namespace

Scene make_knot() {
    std::vector<vec3> points(size_t(kAlong) * kAround);
    parallel_for(kAlong, 16, [&](size_t first, size_t last) {
        for (size_t along = first; along < last; ++along)
            for (uint32_t around = 0; around < kAround; ++around)
                points[along * kAround + around] = vec3(point_on_tube(uint32_t(along), around));
    });
    const auto point = [&](size_t along, size_t around) {
        return points[along % kAlong * kAround + around % kAround];
    };
    Corners corners(points.size() * 6);
    parallel_for(kAlong, 16, [&](size_t first, size_t last) {
        vec3* out = corners.data() + first * kAround * 6;
        for (size_t along = first; along < last; ++along)
            for (size_t around = 0; around < kAround; ++around) {
                const vec3 a = point(along, around), b = point(along + 1, around);
                const vec3 c = point(along + 1, around + 1), d = point(along, around + 1);
                for (const vec3& corner : {a, b, c, a, c, d})
                    *out++ = corner;
            }
    });
    Scene scene;
    scene.materials.push_back({"jade", vec3(0.25f, 0.55f, 0.38f), 0});
    scene.add_mesh("knot", 0, Chunk::owning(dvec3(0), std::move(corners)));
    scene.lights.push_back({dvec3(-5, 7, 4), vec3(3.2f, 3.0f, 2.7f)});
    scene.camera = Camera{dvec3(0, 3.1, 3.4), dvec3(0, -0.1, 0), dvec3(0, 1, 0), 40};
    return scene;
}

} // namespace ovc
