// SPDX-License-Identifier: Apache-2.0
// city: blocks of houses as architects draw them: axis-aligned, coplanar walls, long thin
// triangles.
#include "testscenes/corners.h"
#include "testscenes/random.h"
#include "testscenes/scenes.h"

#include <array>

namespace ovc {

namespace {

constexpr int kBlocks = 18;   // along each side of the town
constexpr double kBlock = 40; // metres from street to street
constexpr double kStorey = 3.2;

enum Look : size_t { Plaster, Brick, Glass, Frame, Street, kLooks };

/// The six sides of a box as twelve triangles.
void add_box(Corners& out, dvec3 lo, dvec3 hi) {
    const auto corner = [&](int i) {
        return dvec3(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    };
    constexpr int sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& s : sides)
        add_quad(out, corner(s[0]), corner(s[1]), corner(s[2]), corner(s[3]));
}

/// Low houses, and a tower here and there.
uint32_t storeys_of(Random& random) {
    const uint32_t low = 2 + random.below(5);
    const uint32_t kind = random.below(3);
    return low + kind * random.below(9);
}

/// A tower: a core of walls, panes set a little before it, posts over the full height, slabs
/// between storeys.
void add_house(std::array<Corners, kLooks>& town, dvec3 lo, dvec3 size, Random& random) {
    const dvec3 hi = lo + size;
    const Look wall = random.chance(0.5) ? Plaster : Brick;
    add_box(town[wall], lo, {hi.x, hi.y - 0.1, hi.z}); // the topmost slab is the roof
    const int storeys = int(size.y / kStorey);
    for (int storey = 1; storey <= storeys; ++storey) { // slabs share the plane of the walls below
        const double y = lo.y + storey * kStorey;
        add_box(town[Frame], {lo.x - 0.3, y - 0.3, lo.z - 0.3}, {hi.x + 0.3, y, hi.z + 0.3});
    }
    constexpr int kPosts = 7;
    for (int post = 0; post <= kPosts; ++post) {
        const double x = lo.x + (size.x - 0.15) * post / kPosts;
        const double z = lo.z + (size.z - 0.15) * post / kPosts;
        for (double side : {lo.z - 0.15, hi.z})
            add_box(town[Frame], {x, lo.y, side}, {x + 0.15, hi.y, side + 0.15});
        for (double side : {lo.x - 0.15, hi.x})
            add_box(town[Frame], {side, lo.y, z}, {side + 0.15, hi.y, z + 0.15});
    }
    for (int storey = 0; storey < storeys; ++storey) {
        const double y = lo.y + storey * kStorey + 0.9;
        for (double side : {lo.z - 0.05, hi.z + 0.05})
            add_quad(town[Glass], {lo.x + 0.3, y, side}, {hi.x - 0.3, y, side},
                     {hi.x - 0.3, y + 1.5, side}, {lo.x + 0.3, y + 1.5, side});
        for (double side : {lo.x - 0.05, hi.x + 0.05})
            add_quad(town[Glass], {side, y, lo.z + 0.3}, {side, y, hi.z - 0.3},
                     {side, y + 1.5, hi.z - 0.3}, {side, y + 1.5, lo.z + 0.3});
    }
}

} // namespace

Scene make_city() {
    std::array<Corners, kLooks> town;
    const double half = 0.5 * kBlocks * kBlock;
    add_quad(town[Street], {-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half});
    for (int row = 0; row < kBlocks; ++row)
        for (int column = 0; column < kBlocks; ++column) {
            Random random(101, uint64_t(row * kBlocks + column));
            for (int house = 0; house < 4; ++house) { // neighbours share a wall
                const dvec3 lo(column * kBlock - half + 5 + 15 * (house % 2), 0,
                               row * kBlock - half + 5 + 15 * (house / 2));
                const double height = kStorey * storeys_of(random);
                add_house(town, lo, {15, height, 15}, random);
            }
        }
    constexpr struct {
        const char* name;
        vec3 color;
        float mirror;
    } kMaterials[kLooks] = {{"plaster", {0.70f, 0.64f, 0.54f}, 0},
                            {"brick", {0.45f, 0.18f, 0.12f}, 0},
                            {"glass", {0.05f, 0.08f, 0.10f}, 0.45f},
                            {"frame", {0.55f, 0.55f, 0.55f}, 0},
                            {"street", {0.16f, 0.16f, 0.17f}, 0}};
    Scene scene;
    for (size_t look = 0; look < kLooks; ++look) {
        const auto& m = kMaterials[look];
        scene.materials.push_back({m.name, m.color, m.mirror});
        scene.add_mesh(m.name, uint32_t(look), Chunk::owning(dvec3(0), std::move(town[look])));
    }
    scene.lights.push_back({dvec3(3000, 2600, 1800), vec3(3.6f, 3.2f, 2.7f)});
    scene.camera = Camera{dvec3(60, 95, 330), dvec3(0, 12, 60), dvec3(0, 1, 0), 40};
    return scene;
}

} // namespace ovc
