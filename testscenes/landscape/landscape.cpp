// SPDX-License-Identifier: Apache-2.0
// landscape-N: heights are fractal noise of the place alone, and stones follow from the tile's
// number, so that each tile can be made by itself.
#include "testscenes/landscape/landscape.h"

#include "core/system/parallel.h"
#include "testscenes/noise.h"
#include "testscenes/random.h"
#include "testscenes/scenes.h"
#include "testscenes/sphere.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {
namespace {

constexpr uint32_t kPebbles = 2; // of 20 triangles, so that tiles have a round number of them
constexpr uint32_t kRocks = (Landscape::kStoneTriangles - kPebbles * 20) / 80;
static_assert(kRocks * 80 + kPebbles * 20 == Landscape::kStoneTriangles);

/// Adds a sphere with bumps around a point. Corners that triangles share stay shared, because bumps
/// depend on the direction alone.
void add_stone(Corners& out, const Corners& sphere, const dvec3& center, double radius,
               uint64_t seed) {
    for (const vec3& corner : sphere) {
        const dvec3 direction(corner);
        const double bump = 1 + 0.3 * noise(direction * 1.7, seed);
        const dvec3 flat(1, 0.7, 1); // stones lie on their broad side
        out.push_back(vec3(center + direction * flat * (radius * bump)));
    }
}

/// Returns the largest divisor of a number up to its root.
uint32_t divisor_near_root(uint32_t number) {
    uint32_t best = 1;
    for (uint32_t d = 1; uint64_t(d) * d <= number; ++d)
        if (number % d == 0)
            best = d;
    return best;
}

} // namespace

Landscape::Landscape(uint32_t millions)
    : columns_(divisor_near_root(millions * kTilesAMillion)),
      rows_(millions * kTilesAMillion / columns_) {
    assert(millions >= 1 && millions <= kMaxLandscape);
}

double Landscape::height(dvec2 at) {
    const double hills = fractal_noise(at * 0.11, 3, 301);
    const double roughness = smooth_step(-0.6, 0.6, hills);
    return 1.6 * hills + 0.25 * roughness * fractal_noise(at * 0.9, 6, 302);
}

dvec2 Landscape::corner_of(uint32_t tile) const {
    assert(tile < tiles());
    return dvec2(tile % columns_, tile / columns_) - dvec2(columns_, rows_) * 0.5;
}

Corners Landscape::ground(uint32_t tile) const {
    constexpr size_t kWidth = kCells + 1;
    const dvec2 corner = corner_of(tile);
    std::vector<vec3> points;
    points.reserve(kWidth * kWidth);
    for (size_t row = 0; row < kWidth; ++row)
        for (size_t column = 0; column < kWidth; ++column) {
            // Whole tiles are added last, so that neighbours compute the same place.
            const dvec2 at(corner.x + double(column) / kCells, corner.y + double(row) / kCells);
            points.emplace_back(dvec3(at.x, height(at), at.y));
        }
    Corners corners;
    corners.reserve(size_t(kGroundTriangles) * 3);
    for (size_t row = 0; row < kCells; ++row)
        for (size_t column = 0; column < kCells; ++column) {
            const vec3* a = &points[row * kWidth + column]; // a d
            const vec3* b = a + kWidth;                     // b c
            corners.insert(corners.end(), {a[0], b[0], b[1], a[0], b[1], a[1]});
        }
    return corners;
}

Corners Landscape::stones(uint32_t tile) const {
    static const Corners rock = make_sphere(1), pebble = make_sphere(0);
    const dvec2 corner = corner_of(tile);
    Random random(303, tile);
    Corners corners;
    corners.reserve(size_t(kStoneTriangles) * 3);
    for (uint32_t i = 0; i < kRocks + kPebbles; ++i) {
        const double x = random.uniform(), z = random.uniform(), size = random.uniform();
        const dvec2 at = corner + dvec2(x, z);
        const double radius = 0.008 + 0.03 * size * size * size * size;
        add_stone(corners, i < kRocks ? rock : pebble, dvec3(at.x, height(at) + 0.3 * radius, at.y),
                  radius, random.bits());
    }
    return corners;
}

Scene Landscape::empty_scene() const {
    Scene scene;
    scene.materials.push_back({"ground", vec3(0.36f, 0.4f, 0.24f), 0});
    scene.materials.push_back({"stone", vec3(0.5f, 0.48f, 0.45f), 0});
    scene.add_mesh("ground", 0, Chunk::owning(dvec3(0), {}));
    scene.add_mesh("stones", 1, Chunk::owning(dvec3(0), {}));
    scene.lights.push_back({dvec3(-300, 400, 200), vec3(3.6f, 3.3f, 2.8f)});
    const dvec2 at(0.25, rows_ * 0.5 - 1.2);
    const double eye = height(at) + 0.45;
    scene.camera =
        Camera{dvec3(at.x, eye, at.y), dvec3(at.x - 1, eye - 1.1, at.y - 4), dvec3(0, 1, 0), 50};
    return scene;
}

bool Landscape::write(TriangleSink& sink) const {
    constexpr uint32_t kTilesAtOnce = 64;
    std::vector<Corners> made(kTilesAtOnce);
    for (const bool stony : {false, true}) {
        sink.begin_mesh();
        for (uint32_t tile = 0; tile < tiles(); tile += kTilesAtOnce) {
            const uint32_t count = std::min(kTilesAtOnce, tiles() - tile);
            parallel_for(count, 1, [&](size_t first, size_t last) {
                for (size_t i = first; i < last; ++i)
                    made[i] = stony ? stones(tile + uint32_t(i)) : ground(tile + uint32_t(i));
            });
            for (uint32_t i = 0; i < count; ++i)
                if (!sink.add_corners(made[i]))
                    return false;
        }
    }
    return true;
}

Scene make_landscape(uint32_t millions) {
    const Landscape landscape(millions);
    Scene scene = landscape.empty_scene();
    for (size_t m = 0; m < 2; ++m) {
        const size_t size = 3 * (m == 0 ? Landscape::kGroundTriangles : Landscape::kStoneTriangles);
        Corners corners(size * landscape.tiles());
        parallel_for(landscape.tiles(), 1, [&](size_t first, size_t last) {
            for (size_t tile = first; tile < last; ++tile)
                std::ranges::copy(m == 0 ? landscape.ground(uint32_t(tile))
                                         : landscape.stones(uint32_t(tile)),
                                  corners.begin() + ptrdiff_t(tile * size));
        });
        scene.soup.chunks[m] = Chunk::owning(dvec3(0), std::move(corners));
    }
    return scene;
}

} // namespace ovc
