// SPDX-License-Identifier: Apache-2.0
// far-terrain: a square of 10,485,760 m whose cells shrink towards the corner farthest from the
// origin, from 131 km to 1 mm. In rings, as a tile server would deliver it: ring k has cells of
// 2^k mm (of 1/1024 m) and an origin of its own, and surrounds what is left of the corner, ring k-1
// half as wide. Rings share their border vertices bit for bit.
#include "testscenes/corners.h"
#include "testscenes/noise.h"
#include "testscenes/scenes.h"

#include "core/system/parallel.h"

#include <cmath>
#include <string>
#include <vector>

namespace ovc {

namespace {

constexpr int kCells = 80; // of a ring, along each side
constexpr int kRings = 28;
constexpr double kFinest = 0x1p-10; // metres
constexpr double kExtent = kCells * kFinest * (1 << (kRings - 1));

/// At a point so far from the corner along x and z. Hills of one shape at every scale, a twentieth
/// as high as they are far away, but never 5 km.
double height(dvec2 from_corner) {
    const double r = std::sqrt(from_corner.x * from_corner.x + from_corner.y * from_corner.y);
    if (r == 0)
        return 0;
    const int octave = std::ilogb(r);
    const double size = std::ldexp(1.0, octave);
    const auto hills = [&](int k) {
        const dvec2 at = from_corner * std::ldexp(6.0, -k);
        return fractal_noise(at, 3, uint64_t(100 + k));
    };
    const double nearer = hills(octave), farther = hills(octave + 1), share = r / size - 1;
    return 0.05 * r / (1 + r / 1e5) * (nearer + share * (farther - nearer));
}

/// Coordinates are small multiples of half a cell, so origin + offset is exact in double.
class Ring {
public:
    explicit Ring(int number)
        : number_(number),
          cell_(kFinest * double(1 << number)),
          origin_(kExtent - kCells * cell_, 0, kExtent - kCells * cell_) {}

    Chunk chunk() const {
        Corners corners;
        for (int x = 0; x < kCells; ++x)
            for (int z = 0; z < kCells; ++z)
                if (number_ == 0 || x < kInner || z < kInner)
                    add_cell(corners, x, z);
        return Chunk::owning(origin_, std::move(corners));
    }

private:
    /// The place where the finer ring begins, in both directions.
    static constexpr int kInner = kCells / 2;

    dvec3 point(double x, double z) const {
        const dvec2 from_corner = dvec2(kCells - x, kCells - z) * cell_;
        return {x * cell_, height(from_corner), z * cell_};
    }

    /// Two triangles, or three where the finer ring has a vertex in the middle of a side.
    void add_cell(Corners& out, int x, int z) const {
        std::vector<dvec3> outline = {point(x, z), point(x, z + 1), point(x + 1, z + 1),
                                      point(x + 1, z)};
        if (number_ > 0 && x == kInner - 1 && z >= kInner)
            outline.insert(outline.begin() + 3, point(x + 1, z + 0.5));
        if (number_ > 0 && z == kInner - 1 && x >= kInner)
            outline.insert(outline.begin() + 2, point(x + 0.5, z + 1));
        for (size_t i = 2; i < outline.size(); ++i)
            add_triangle(out, outline[0], outline[i - 1], outline[i]);
    }

    int number_;
    double cell_;
    dvec3 origin_;
};

} // namespace

Scene make_far_terrain() {
    std::vector<Chunk> chunks;
    for (int ring = 0; ring < kRings; ++ring)
        chunks.push_back(Chunk::owning(dvec3(0), {}));
    parallel_for(kRings, 1, [&](size_t first, size_t last) {
        for (size_t ring = first; ring < last; ++ring)
            chunks[ring] = Ring(int(ring)).chunk();
    });
    Scene scene;
    scene.materials.push_back({"sand", vec3(0.62f, 0.5f, 0.33f), 0});
    scene.materials.push_back({"moss", vec3(0.33f, 0.42f, 0.22f), 0});
    for (int ring = 0; ring < kRings; ++ring)
        scene.add_mesh("ring " + std::to_string(ring), uint32_t(ring % 2),
                       std::move(chunks[size_t(ring)]));
    const dvec3 corner(kExtent, 0, kExtent);
    scene.lights.push_back({corner + dvec3(-1.5e7, 0.8e7, 1e7), vec3(4.0f, 3.6f, 3.0f)});
    scene.camera = Camera{corner + dvec3(-0.004, 0.03, -0.004), corner + dvec3(-0.2, 0, -0.2),
                          dvec3(0, 1, 0), 50};
    return scene;
}

} // namespace ovc
