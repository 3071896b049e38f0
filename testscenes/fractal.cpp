// SPDX-License-Identifier: Apache-2.0
// fractal: a bumpy ball that carries seven smaller ones, each of which carries seven, and so on:
// one mesh in 25,250 places. Based on: Haines 1987, "A Proposal for Standard Graphics Environments"
// (the balls of "sphereflake").
#include "testscenes/corners.h"
#include "testscenes/scenes.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace ovc {
namespace {

constexpr uint32_t kBallSegments = 164, kBallRings = 92; // 2 x 164 x 91 triangles
constexpr double kSmaller = 0.38;                        // a ball to the one that carries it
using std::numbers::pi;

/// The bumps of a ball of about 1 are a twentieth high.
vec3 corner_at(uint32_t segment, uint32_t ring) {
    const double around = 2 * pi * (segment % kBallSegments) / kBallSegments,
                 down = pi * ring / kBallRings;
    const double width = ring == 0 || ring == kBallRings ? 0 : std::sin(down);
    const dvec3 p(width * std::cos(around), std::cos(down), width * std::sin(around));
    const double bump = std::sin(9 * p.x) * std::sin(9 * p.y + 1) * std::sin(9 * p.z + 2);
    return vec3(p * (1 + 0.05 * bump));
}

Corners ball() {
    Corners out;
    for (uint32_t ring = 0; ring < kBallRings; ++ring)
        for (uint32_t segment = 0; segment < kBallSegments; ++segment) {
            const vec3 a = corner_at(segment, ring), b = corner_at(segment + 1, ring),
                       c = corner_at(segment + 1, ring + 1), d = corner_at(segment, ring + 1);
            if (ring > 0)
                out.insert(out.end(), {a, b, d});
            if (ring + 1 < kBallRings)
                out.insert(out.end(), {b, c, d});
        }
    return out;
}

/// A ball of the size `size` at `place`, whose own axes are the columns of `axes`.
struct Ball {
    dvec3 place{0};
    dmat3 axes{1};
    double size = 1;

    Transform transform() const {
        Transform transform{};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                transform.rows[size_t(row)][size_t(column)] = size * axes[column][row];
            transform.rows[size_t(row)][3] = place[row];
        }
        return transform;
    }

    /// One of the seven that it carries: six around it, one on top.
    Ball carried(int which) const {
        const double around = which * pi / 3, up = which == 6 ? pi / 2 : 0.2;
        const dvec3 y(std::cos(up) * std::cos(around), std::sin(up),
                      std::cos(up) * std::sin(around)); // its own upwards
        const dvec3 z =
            glm::normalize(glm::cross(y, dvec3(std::sin(around), 0, -std::cos(around))));
        const dmat3 turned(glm::cross(y, z), y, z);
        return {place + axes * y * (size * (1 + kSmaller)), axes * turned, size * kSmaller};
    }
};

} // namespace

Scene make_fractal(uint32_t count) {
    std::vector<Ball> balls{Ball()};
    for (size_t next = 0; balls.size() < count; ++next)
        for (int which = 0; which < 7 && balls.size() < count; ++which)
            balls.push_back(balls[next].carried(which));
    Scene scene;
    scene.materials.push_back({"ball", vec3(0.75f, 0.55f, 0.35f), 0});
    for (const Ball& at : balls) {
        Chunk chunk = scene.soup.chunks.empty() ? Chunk::owning(dvec3(0), ball())
                                                : scene.soup.chunks.front().unplaced();
        chunk.place(at.transform());
        scene.add_mesh("ball", 0, std::move(chunk));
    }
    scene.lights.push_back({dvec3(8, 12, 10), vec3(3)});
    scene.camera = Camera{dvec3(2.2, 2.8, 5.2), dvec3(0, 0.35, 0), dvec3(0, 1, 0), 40};
    return scene;
}

} // namespace ovc
