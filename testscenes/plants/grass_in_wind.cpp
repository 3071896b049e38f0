// SPDX-License-Identifier: Apache-2.0
// grass-in-wind: tufts of the plants' grass, which gusts bend. A tuft is an instance that is
// sheared along the wind, so from one frame to the next transforms alone change.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/plants/prototype.h"
#include "testscenes/scenes.h"

#include <array>

namespace ovc {
namespace {

constexpr uint32_t kKinds = 6, kSide = 90; // 8,100 tufts
constexpr double kApart = 0.16, kReach = 0.5 * kApart * kSide;
constexpr dvec2 kWind(0.8, 0.6);

/// How far the wind bends grass at (x, z), in its own heights. The clock's last moment is its first
/// again.
double bend_at(double x, double z, double clock) {
    const double along = kWind.x * x + kWind.y * z, across = kWind.x * z - kWind.y * x;
    const double gust = circle(0.13 * along - clock + 0.11 * circle(0.14 * across).y).y;
    const double flutter = circle(0.9 * along + 0.5 * across - 5 * clock).y;
    return 0.35 + 0.28 * gust + 0.05 * flutter;
}

Transform placed(dvec2 at, double turn, double size, double clock) {
    const double c = size * circle(turn).x, s = size * circle(turn).y,
                 bend = size * bend_at(at.x, at.y, clock);
    return {{{{c, bend * kWind.x, s, at.x}, {0, size, 0, 0}, {-s, bend * kWind.y, c, at.y}}}};
}

} // namespace

Scene make_grass_in_wind(double clock) {
    Scene scene;
    scene.moves = true;
    scene.materials = {{"ground", vec3(0.3f, 0.27f, 0.17f)}};
    Corners ground;
    constexpr double g = 1.4 * kReach;
    add_quad(ground, {-g, 0, -g}, {-g, 0, g}, {g, 0, g}, {g, 0, -g});
    scene.add_mesh("ground", 0, Chunk::owning(dvec3(0), std::move(ground)));
    for (uint32_t kind = 0; kind < kKinds; ++kind) {
        const float tint = float(kind) / (kKinds - 1);
        scene.materials.push_back({"grass", vec3(0.25f + 0.2f * tint, 0.5f, 0.1f + 0.06f * tint)});
    }
    std::array<uint32_t, kKinds> first{}; // the mesh of each kind's first tuft; 0: none yet
    Random random(5);
    for (uint32_t i = 0; i < kSide * kSide; ++i) {
        const uint32_t kind = random.below(kKinds);
        const dvec2 at =
            kApart * dvec2(i % kSide + random.uniform(), i / kSide + random.uniform()) -
            dvec2(kReach);
        const double turn = random.uniform(), size = random.uniform(0.8, 1.4);
        Chunk tuft = first[kind] != 0
                         ? scene.soup.chunks[first[kind]].unplaced()
                         : Chunk::owning(dvec3(0), plants::make_grass(Random(100 + kind),
                                                                      1)[plants::Part::Tinted]);
        tuft.place(placed(at, turn, size, clock));
        const uint32_t mesh = scene.add_mesh("tuft", 1 + kind, std::move(tuft));
        first[kind] = first[kind] != 0 ? first[kind] : mesh;
    }
    scene.lights.push_back({dvec3(-20, 30, 25), vec3(2.8f)});
    scene.camera = Camera{dvec3(0, 1.1, kReach), dvec3(0, 0.1, 0.3 * kReach), dvec3(0, 1, 0), 50};
    return scene;
}

} // namespace ovc
