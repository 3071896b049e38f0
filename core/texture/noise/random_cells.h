// SPDX-License-Identifier: Apache-2.0
// Patterns that fill unit cells at random, with the values of POV-Ray's: cells, crackle and the
// sources of ripples and waves.
#pragma once

#include "core/texture/noise/noise.h"

#include <array>
#include <span>

namespace ovc {

/// Returns the random number from 0 to 1 of the unit cell that the point lies in.
double cell_value(const dvec3& at);

/// How crackle measures distances: |x|^metric + |y|^metric + |z|^metric + |offset|^metric, to the
/// power of 1 / metric.
struct CrackleMetric {
    double metric = 2;
    double offset = 0;
};

/// The points of a random set that are nearest to a place. Each unit cell has one point.
struct NearestPoints {
    std::array<double, 3> distance; // in ascending order
    dvec3 nearest;
};
NearestPoints nearest_points(const dvec3& at, const CrackleMetric& metric);

/// The points from which ripples and waves run out, of length 1, and the frequencies of waves.
struct WaveSource {
    dvec3 at;
    double frequency;
};
inline constexpr size_t kMaxWaveSources = 1000;

/// Returns the first `count` sources, but at most kMaxWaveSources; 0 stands for povray's default.
std::span<const WaveSource> wave_sources(double count);

} // namespace ovc
