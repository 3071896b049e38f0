// SPDX-License-Identifier: Apache-2.0
// The ground and the water of the plants scene.
#include "testscenes/plants/ground.h"

#include "core/system/parallel.h"
#include "testscenes/noise.h"
#include "testscenes/plants/landscape.h"

#include <algorithm>
#include <cmath>

namespace ovc::plants {

namespace {

/// Maps [-1, 1] onto [-kReach, kReach]; cells in the middle are the smallest.
double spread(double s) {
    const double s2 = s * s;
    return kReach * s * (0.03 + 0.42 * s2 + 0.55 * s2 * s2);
}

Cover cover_at(dvec2 at, double height, double slope) {
    // Noise on the thresholds dissolves the borders.
    const double grain = noise(at / 0.7, 41) + noise(at / 5.0, 42);
    const double shore = shore_distance(at);
    if (height < 0.04 + 0.03 * grain)
        return Cover::Mud;
    if (shore < 1.6 + 0.7 * grain)
        return Cover::Sand;
    if (slope > 0.95 + 0.15 * grain)
        return Cover::Stone;
    const double patches = fractal_noise(at / 60.0, 4, 44);
    if (glm::length(at - kViewpoint) > 520 + 150 * patches)
        return height > 62 + 55 * patches ? Cover::FarRidge : Cover::FarWood;
    if (shore > 40 + 12 * grain && slope + 0.1 * grain > 0.22)
        return Cover::ForestFloor;
    return fractal_noise(at / 11.0, 3, 43) + 0.25 * grain > 0.15 ? Cover::DryMeadow : Cover::Meadow;
}

struct Band {
    std::array<Corners, kCovers> by_cover;
};

Band make_band(const std::vector<dvec3>& points, uint32_t cells, uint32_t row) {
    Band band;
    const uint32_t width = cells + 1;
    for (uint32_t column = 0; column < cells; ++column) {
        const dvec3& a = points[size_t(row) * width + column];
        const dvec3& b = points[size_t(row) * width + column + 1];
        const dvec3& c = points[size_t(row + 1) * width + column + 1];
        const dvec3& d = points[size_t(row + 1) * width + column];
        const dvec3 middle = (a + b + c + d) * 0.25;
        const dvec3 normal = glm::cross(d - b, c - a);
        const double slope =
            std::sqrt(normal.x * normal.x + normal.z * normal.z) / std::abs(normal.y);
        Corners& out = band.by_cover[size_t(cover_at({middle.x, middle.z}, middle.y, slope))];
        // The diagonal alternates, so that no direction is favoured.
        if ((row + column) % 2)
            add_quad(out, a, d, c, b);
        else
            add_quad(out, b, a, d, c);
    }
    return band;
}

} // namespace

std::array<Corners, kCovers> make_ground(uint32_t cells) {
    const uint32_t width = cells + 1;
    std::vector<dvec3> points(size_t(width) * width);
    parallel_for(width, 4, [&](size_t first, size_t last) {
        for (size_t row = first; row < last; ++row)
            for (uint32_t column = 0; column < width; ++column) {
                const dvec2 at = kViewpoint + dvec2(spread(2.0 * column / cells - 1),
                                                    spread(1.4 * double(row) / cells - 1));
                points[row * width + column] = {at.x, ground_height(at), at.y};
            }
    });
    std::vector<Band> bands(cells);
    parallel_for(cells, 4, [&](size_t first, size_t last) {
        for (size_t row = first; row < last; ++row)
            bands[row] = make_band(points, cells, uint32_t(row));
    });
    std::array<Corners, kCovers> ground;
    for (const Band& band : bands)
        for (size_t cover = 0; cover < kCovers; ++cover)
            ground[cover].insert(ground[cover].end(), band.by_cover[cover].begin(),
                                 band.by_cover[cover].end());
    return ground;
}

Corners make_water() {
    constexpr int kCells = 48; // one large quad would reach into every leaf of a tree
    const auto point = [](int column, int row) {
        return dvec3(kReach * (2.0 * column / kCells - 1), 0, kReach * (1.2 * row / kCells - 1));
    };
    Corners water;
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column)
            add_quad(water, point(column, row), point(column, row + 1), point(column + 1, row + 1),
                     point(column + 1, row));
    return water;
}

} // namespace ovc::plants
