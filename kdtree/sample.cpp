// SPDX-License-Identifier: Apache-2.0
// Samples: chooses the rate, and draws triangles by their hash.
#include "kdtree/sample.h"

#include "core/corner_hash.h"
#include "core/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace ovc {
namespace {

// Measured (docs/benchmarks.md, "The plan"): this many triangles keep the planes, the number of
// leaves and the triangles that planes cut within a few percent of those of all triangles.
constexpr uint64_t kMinInAll = 8192;
constexpr uint64_t kMinInALeaf = 128;
constexpr uint64_t kHighestRate = 64; // at higher rates, drawing a sample costs more than using it

} // namespace

uint32_t sample_rate(uint64_t triangles, uint64_t leaf_triangles) {
    const uint64_t rate =
        std::min({triangles / kMinInAll, leaf_triangles / kMinInALeaf, kHighestRate});
    return uint32_t(std::bit_floor(std::max<uint64_t>(rate, 1)));
}

std::vector<TriangleId> sample_triangles(const Soup& soup, std::span<const TriangleId> triangles,
                                         uint32_t rate, BuildProgress* progress) {
    assert(std::has_single_bit(rate));
    if (rate == 1)
        return {triangles.begin(), triangles.end()};
    // Each block has a list of its own, so that the order never depends on threads.
    constexpr size_t kBlock = 1 << 16;
    std::vector<std::vector<TriangleId>> parts(triangles.size() / kBlock + 1);
    parallel_for(parts.size(), 1, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        for (size_t b = first; b < last; ++b) {
            const size_t end = std::min(triangles.size(), (b + 1) * kBlock);
            for (size_t i = b * kBlock; i < end; ++i, loop.step()) {
                const Triangle t = soup.triangle(triangles[i]);
                if ((triangle_hash(t) & (rate - 1)) == 0)
                    parts[b].push_back(triangles[i]);
            }
        }
        loop.finish();
    });
    std::vector<TriangleId> sample;
    for (const auto& part : parts)
        sample.insert(sample.end(), part.begin(), part.end());
    return sample;
}

} // namespace ovc
