// SPDX-License-Identifier: Apache-2.0
// Level 1, then all pages in parallel; again with smaller leaves when a page turns out too large.
#include "plugin/level2.h"

#include "core/parallel.h"
#include "core/stopwatch.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace ovc {
namespace {

/// What a triangle takes in a page where most pair up; soups without shared edges take up to twice
/// as much.
constexpr double kBytesPerTriangle = 52;

struct TooLarge {
    uint64_t bytes = 0;
    uint64_t triangles = 1;
};

/// All pages, or the first page found too large: then the rest is not built.
TooLarge build_pages(const Soup& soup, const Numbering& numbers, uint64_t page_bytes,
                     Levels& levels) {
    const std::vector<Leaf>& leaves = levels.level1.leaves;
    levels.pages.clear();
    levels.pages.resize(leaves.size());
    std::atomic<int64_t> too_large{-1};
    parallel_for(leaves.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last && too_large < 0; ++i) {
            levels.pages[i] = build_page(soup, numbers, leaves[i]);
            if (levels.pages[i].bytes() > page_bytes)
                too_large = int64_t(i);
        }
    });
    if (too_large < 0)
        return {};
    const size_t i = size_t(too_large);
    return {levels.pages[i].bytes(), leaves[i].triangles.size()};
}

} // namespace

Result<Levels> build_levels(const Soup& soup, const Numbering& numbers,
                            std::span<const TriangleId> triangles, const Box& bounds,
                            uint64_t leaf_triangles, uint64_t page_bytes) {
    Levels levels;
    uint64_t most = std::min(leaf_triangles, uint64_t(double(page_bytes) / kBytesPerTriangle));
    while (true) {
        if (most == 0)
            return Error{
                fmt::format("a page of one triangle does not fit into {} bytes", page_bytes)};
        Stopwatch watch;
        levels.level1 =
            partition(soup, triangles, bounds, uint32_t(std::min<uint64_t>(most, kNone)));
        levels.seconds_level1 += watch.seconds();
        watch = Stopwatch();
        const TooLarge page = build_pages(soup, numbers, page_bytes, levels);
        levels.seconds_level2 += watch.seconds();
        if (page.bytes == 0)
            return levels;
        // What this page took a triangle, and a little more, tells how many fit; always fewer than
        // before.
        const double fit = 0.95 * double(page_bytes) / double(page.bytes) * double(page.triangles);
        most = std::min(most - 1, uint64_t(fit));
    }
}

} // namespace ovc
