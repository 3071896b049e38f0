// SPDX-License-Identifier: Apache-2.0
// Which random numbers POV-Ray takes was found by asking it for values: cells shows the numbers of
// a Mersenne Twister with its usual seed (Matsumoto and Nishimura 1998), and the distances of
// crackle tell the points. docs/decisions/0033-textures-are-trees-in-the-scene.md says how.
#include "core/texture/noise/random_cells.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace ovc {

namespace {

constexpr uint32_t kNumbers = 4096; // of cells

/// A pattern of cells changes this far off whole numbers, as pattern.cpp explains.
constexpr double kOffGrid = 1e-6;

/// Returns the random numbers from 0 to 1 of all cells. A point takes three in a row.
const std::vector<double>& random_numbers() {
    static const std::vector<double> kAll = [] {
        std::mt19937 twister; // with the default seed, 5489
        std::vector<double> all(kNumbers + 2);
        for (double& number : all)
            number = twister() * 0x1p-32;
        return all;
    }();
    return kAll;
}

uint32_t number_of_cell(const dvec3& low) {
    const dvec3 cell = glm::clamp(low, -1e15, 1e15);
    return cell_number(int64_t(cell.x), int64_t(cell.y), int64_t(cell.z));
}

dvec3 point_of_cell(const dvec3& low) {
    const double* numbers = random_numbers().data() + number_of_cell(low);
    return low + dvec3(numbers[0], numbers[1], numbers[2]);
}

/// Returns the distance to the power of the metric, which orders points alike.
double power_of_distance(const dvec3& way, const CrackleMetric& metric) {
    const dvec3 a = glm::abs(way);
    if (metric.metric == 2)
        return glm::dot(a, a) + metric.offset * metric.offset;
    const double m = metric.metric;
    const double offset = metric.offset == 0 ? 0 : std::pow(std::abs(metric.offset), m);
    return std::pow(a.x, m) + std::pow(a.y, m) + std::pow(a.z, m) + offset;
}

double distance_of(double power, const CrackleMetric& metric) {
    return metric.metric == 2 ? std::sqrt(power) : std::pow(power, 1 / metric.metric);
}

/// Returns the cells up to two away from one, the nearest first.
const std::vector<dvec3>& cells_around() {
    static const std::vector<dvec3> kAll = [] {
        std::vector<dvec3> all;
        for (int i = 0; i < 125; ++i)
            all.push_back(dvec3(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2));
        std::stable_sort(all.begin(), all.end(), [](const dvec3& a, const dvec3& b) {
            return glm::dot(a, a) < glm::dot(b, b);
        });
        return all;
    }();
    return kAll;
}

} // namespace

double cell_value(const dvec3& at) {
    return random_numbers()[number_of_cell(glm::floor(at + kOffGrid))];
}

NearestPoints nearest_points(const dvec3& at, const CrackleMetric& metric) {
    const dvec3 low = glm::floor(at + kOffGrid);
    NearestPoints found{{1e300, 1e300, 1e300}, at};
    double third = 1e300; // the distance to the third nearest point
    // The three nearest points lie within two cells: each cell around has a point of its own.
    for (const dvec3& cell : cells_around()) {
        const dvec3 gap = glm::max(low + cell - at, at - low - cell - 1.0);
        if (max_component(gap) >= third) // in any metric the cell is farther away
            continue;
        const dvec3 point = point_of_cell(low + cell);
        const double away = power_of_distance(point - at, metric);
        if (away < found.distance[0])
            found.nearest = point;
        const auto after = std::upper_bound(found.distance.begin(), found.distance.end(), away);
        if (after == found.distance.end())
            continue;
        std::copy_backward(after, found.distance.end() - 1, found.distance.end());
        *after = away;
        third = distance_of(found.distance[2], metric);
    }
    for (double& away : found.distance)
        away = distance_of(away, metric);
    return found;
}

std::span<const WaveSource> wave_sources(double count) {
    static const std::array<WaveSource, kMaxWaveSources> kAll = [] {
        std::array<WaveSource, kMaxWaveSources> all;
        uint32_t state = 1952292254; // of the generator of rand() when it gives the first frequency
        for (size_t i = 0; i < kMaxWaveSources; ++i) {
            const double share = double(state >> 16 & 0x7fff) / 0x7fff;
            all[i] = {glm::normalize(vector_noise({double(i), 0, 0})), share + 0.01};
            state = state * 1812433253u + 12345u;
        }
        return all;
    }();
    constexpr size_t kDefault = 10;
    return std::span(kAll).first(count >= 1 ? size_t(std::min(count, double(kMaxWaveSources)))
                                            : kDefault);
}

} // namespace ovc
