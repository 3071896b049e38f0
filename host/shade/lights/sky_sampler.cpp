// SPDX-License-Identifier: Apache-2.0
// Based on: Pharr, Jakob and Humphreys, "Physically Based Rendering", third edition, section
// 14.2.4: a table of luminance by longitude and latitude, inverted row by row.
#include "host/shade/lights/sky_sampler.h"

#include "core/system/parallel.h"
#include "core/texture/luminance.h"
#include "host/shade/shade.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

constexpr size_t kRows = 128, kColumns = 256;
/// So many looks at each cell and each way, so that a small sun is not missed.
constexpr int kLooks = 4;
/// The share of choices that goes to all directions alike: the table is coarser than the sky.
constexpr double kEven = 0.1;

constexpr double kSphere = 4 * std::numbers::pi;

dvec3 direction_of(double row, double column) {
    const double theta = std::numbers::pi * row / kRows,
                 phi = 2 * std::numbers::pi * column / kColumns;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// Returns the solid angle of a cell.
double angle_of_cell(size_t row) {
    return 2 * std::numbers::pi / kColumns *
           (std::cos(std::numbers::pi * double(row) / kRows) -
            std::cos(std::numbers::pi * double(row + 1) / kRows));
}

double mean_of_cell(const Scene& scene, const vec3& up, size_t row, size_t column) {
    double sum = 0;
    for (int y = 0; y < kLooks; ++y)
        for (int x = 0; x < kLooks; ++x) {
            const vec3 c = background_color(scene, up,
                                            direction_of(double(row) + (y + 0.5) / kLooks,
                                                         double(column) + (x + 0.5) / kLooks));
            sum += std::max(luminance(c), 0.0);
        }
    return std::isfinite(sum) ? sum / (kLooks * kLooks) : 0;
}

bool has_picture(const Scene& scene) {
    return std::ranges::any_of(scene.background.layers, [&](const PlacedTexture& layer) {
        const Texture& texture = scene.textures[layer.texture];
        return texture.image && texture.image->lookup;
    });
}

/// A cell of running sums, from the one before it, and where `at` lies in it, from 0 to 1.
struct FoundCell {
    size_t cell;
    double within, share;
};

FoundCell find_cell(const double* sums, size_t count, double at) {
    const size_t cell =
        std::min(size_t(std::upper_bound(sums, sums + count, at) - sums), count - 1);
    const double before = cell == 0 ? 0 : sums[cell - 1], share = sums[cell] - before;
    return {cell, share > 0 ? std::clamp((at - before) / share, 0.0, 1.0) : 0.5, share};
}

} // namespace

SkySampler::SkySampler(const Scene& scene, const vec3& up) {
    if (!has_picture(scene))
        return;
    std::vector<double> light(kRows * kColumns);
    parallel_for(kRows, 1, [&](size_t first, size_t last) {
        for (size_t row = first; row < last; ++row)
            for (size_t column = 0; column < kColumns; ++column)
                light[row * kColumns + column] =
                    mean_of_cell(scene, up, row, column) * angle_of_cell(row);
    });
    double sum = 0;
    for (const double cell : light)
        sum += cell;
    mean_ = sum / kSphere;
    if (!(sum > 0) || !std::isfinite(sum))
        return;
    double all = 0;
    columns_.resize(light.size());
    for (size_t row = 0; row < kRows; ++row) {
        const double even = kEven * angle_of_cell(row) / kSphere;
        double of_row = 0;
        for (size_t column = 0; column < kColumns; ++column) {
            of_row += (1 - kEven) * light[row * kColumns + column] / sum + even;
            columns_[row * kColumns + column] = of_row;
        }
        for (size_t column = 0; column < kColumns; ++column)
            columns_[row * kColumns + column] /= of_row;
        rows_.push_back(all += of_row);
    }
    for (double& row : rows_)
        row /= all;
}

/// Within a cell directions are chosen evenly by solid angle.
SkySample SkySampler::sample(const dvec2& u) const {
    assert(shines());
    const FoundCell row = find_cell(rows_.data(), kRows, u.y);
    const FoundCell column = find_cell(&columns_[row.cell * kColumns], kColumns, u.x);
    const double top = std::cos(std::numbers::pi * double(row.cell) / kRows);
    const double below = std::cos(std::numbers::pi * double(row.cell + 1) / kRows);
    const double z = glm::mix(top, below, row.within);
    const double phi = 2 * std::numbers::pi * (double(column.cell) + column.within) / kColumns;
    const double r = std::sqrt(std::max(1 - z * z, 0.0));
    return {{r * std::cos(phi), r * std::sin(phi), z},
            row.share * column.share / angle_of_cell(row.cell)};
}

double SkySampler::density(const dvec3& direction) const {
    assert(shines());
    const double theta = std::acos(std::clamp(direction.z, -1.0, 1.0));
    const double turn = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi);
    const size_t row = std::min(size_t(theta / std::numbers::pi * kRows), kRows - 1);
    const size_t column = std::min(size_t((turn < 0 ? turn + 1 : turn) * kColumns), kColumns - 1);
    const auto share = [](const double* sums, size_t cell) {
        return sums[cell] - (cell == 0 ? 0 : sums[cell - 1]);
    };
    return share(rows_.data(), row) * share(&columns_[row * kColumns], column) / angle_of_cell(row);
}

} // namespace ovc
