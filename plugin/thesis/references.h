// SPDX-License-Identifier: Apache-2.0
// References: which triangles lie in which place (a cell of a grid, a leaf of a KD-tree), gathered
// by many threads and sorted by place.
#pragma once

#include "core/soup.h"
#include "core/system/parallel.h"
#include "plugin/thesis/system.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc::thesis {

struct Reference {
    uint32_t place;
    uint32_t triangle;
};

/// Place p lists triangles[first[p]] up to triangles[first[p + 1]], in order.
struct References {
    std::vector<uint32_t> first; // places + 1
    std::vector<uint32_t> triangles;
};

/// Returns the references that find(triangle, out) appends for each triangle, with places below
/// `places`. It is called from several threads at once. A triangle is a unit of progress.
template <class Find>
References gather_references(size_t triangles, size_t places, BuildProgress* progress,
                             Find&& find) {
    // Each block has a list of its own, so that the order never depends on threads.
    constexpr size_t kBlock = 4096;
    std::vector<std::vector<Reference>> blocks((triangles + kBlock - 1) / kBlock);
    parallel_for(blocks.size(), 1, [&](size_t from, size_t to) {
        for (size_t b = from; b < to; ++b) {
            for (size_t i = b * kBlock; i < std::min(triangles, (b + 1) * kBlock); ++i)
                find(uint32_t(i), blocks[b]);
            add(progress, kBlock);
        }
    });
    References sorted;
    sorted.first.assign(places + 1, 0);
    for (const auto& block : blocks)
        for (const Reference& r : block) {
            assert(r.place < places);
            ++sorted.first[r.place + 1];
        }
    for (size_t p = 0; p < places; ++p)
        sorted.first[p + 1] += sorted.first[p];
    sorted.triangles.resize(sorted.first[places]);
    std::vector<uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
    for (const auto& block : blocks)
        for (const Reference& r : block)
            sorted.triangles[next[r.place]++] = r.triangle;
    return sorted;
}

/// Appends the words, four per texel.
inline void append(Texels& texels, const std::vector<uint32_t>& words) {
    for (size_t i = 0; i < words.size(); i += 4) {
        const auto word = [&](size_t k) { return i + k < words.size() ? words[i + k] : 0u; };
        texels.push_back({word(0), word(1), word(2), word(3)});
    }
}

} // namespace ovc::thesis
