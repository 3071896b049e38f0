// SPDX-License-Identifier: Apache-2.0
// Tests whether triangles close a volume, and which way they face.
#pragma once

#include "core/soup.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>
#include <vector>

namespace ovc {

using CornerBits = std::array<uint32_t, 3>;

inline CornerBits bits_of(const vec3& v) {
    // -0 and 0 are the same place.
    return {std::bit_cast<uint32_t>(v.x + 0.0f), std::bit_cast<uint32_t>(v.y + 0.0f),
            std::bit_cast<uint32_t>(v.z + 0.0f)};
}

/// Counts the edges that triangles do not run along equally often in both directions.
inline uint64_t open_edges(std::span<const vec3> corners) {
    std::map<CornerBits, uint32_t> numbers;
    std::vector<uint32_t> corner;
    for (const vec3& v : corners)
        corner.push_back(numbers.try_emplace(bits_of(v), uint32_t(numbers.size())).first->second);
    std::vector<std::pair<uint32_t, uint32_t>> edges, reversed;
    for (size_t i = 0; i < corner.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            edges.emplace_back(corner[i + k], corner[i + (k + 1) % 3]);
            reversed.emplace_back(edges.back().second, edges.back().first);
        }
    std::ranges::sort(edges);
    std::ranges::sort(reversed);
    const bool twice = std::ranges::adjacent_find(edges) != edges.end();
    uint64_t open = twice;
    for (size_t i = 0; i < edges.size(); ++i)
        open += edges[i] != reversed[i];
    return open;
}

/// Returns the volume within the triangles, which is positive if the faces look outwards.
inline double enclosed_volume(std::span<const vec3> corners) {
    double sum = 0;
    for (size_t i = 0; i < corners.size(); i += 3)
        sum +=
            glm::dot(dvec3(corners[i]), glm::cross(dvec3(corners[i + 1]), dvec3(corners[i + 2]))) /
            6;
    return sum;
}

} // namespace ovc
