// SPDX-License-Identifier: Apache-2.0
// Page: the BVH of one leaf as texels, in the layout of shaders/layout.h. Level 2 moves in and out
// of GPU memory by whole pages.
#pragma once

#include "core/build_progress.h"
#include "core/numbering.h"
#include "core/soup.h"
#include "core/system/line_allocator.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The texels of a page's header and root, by which a tree over pages is built.
inline constexpr size_t kHeadTexels = (OVC_ROOT_UNIT + 1) * OVC_UNIT_TEXELS;

/// Units that each lie in a cache line of their own.
using Texels = std::vector<uvec4, LineAllocator<uvec4>>;

struct Page {
    Texels texels;                     // of a page that was built; empty if they are borrowed
    std::span<const uvec4> borrowed{}; // the owner keeps them alive and unchanged
    uint32_t depth = 0;                // nodes on the longest way down
    float built_cost = 0;              // of a ray before the first refit (refit.h); 0: none yet
    /// A page that lies on a disk has these bytes, and a number there. Its view() is the head.
    uint64_t stored_bytes = 0;
    uint32_t stored_number = 0;

    std::span<const uvec4> view() const { return borrowed.empty() ? texels : borrowed; }
    uint64_t units() const { return bytes() / OVC_UNIT_BYTES; }
    uint64_t bytes() const { return stored_bytes ? stored_bytes : view().size_bytes(); }
    bool has_loose_pairs() const {
        return !view().empty() && view()[OVC_LOOSE_TEXEL].x == OVC_HAS_LOOSE_PAIRS;
    }
};

/// Returns the box of a child of a node, whose unit is in the page's view(), in the frame of the
/// page's leaf. Empty where there is no such child.
Box child_box(const Page& page, uint32_t node, uint32_t child);

/// Returns the box of the page's tree, in the frame of its leaf. All triangles lie inside.
Box box_of(const Page& page);

inline uint64_t total_bytes(std::span<const Page> pages) {
    uint64_t bytes = 0;
    for (const Page& page : pages)
        bytes += page.bytes();
    return bytes;
}
inline uint64_t largest_bytes(std::span<const Page> pages) {
    uint64_t bytes = 0;
    for (const Page& page : pages)
        bytes = std::max(bytes, page.bytes());
    return bytes;
}

/// Returns how many stack words the kernel needs for all of these pages, rounded up to an even
/// number so that few programs serve all scenes.
uint32_t stack_depth(std::span<const Page> pages);
uint32_t stack_depth(uint32_t depth);

/// The max number of cuts by planes for each triangle in loose pairs, level 1's and the page's
/// together.
inline constexpr double kMaxCutOfLoose = 0.8;

/// Whether triangles that share no side may lie in one unit (loose_pairs.h). build_page() does so
/// if it is worth it. Only kernels with OVC_LOOSE_PAIRS can read such pages.
struct LoosePairs {
    bool allowed = false;
    double copies = 1; // of a triangle in all leaves, on average: 1 if level 1 cut none

    /// The max share of a page's pairs that planes may cut in two.
    double max_cut() const { return std::max((1 + kMaxCutOfLoose) / copies - 1, 0.0); }
};

/// Builds and packs the BVH of a leaf, which has triangles. The page names them by their numbers in
/// the soup. A triangle counts as about two units of progress.
Page build_page(const Soup& soup, const Numbering& numbers, const Leaf& leaf,
                BuildProgress* progress = nullptr, const LoosePairs& loose = {});

/// The same, but the page names the triangle leaf.triangles[i] by numbers[i].
Page build_page(const Soup& soup, std::span<const uint32_t> numbers, const Leaf& leaf,
                BuildProgress* progress = nullptr, const LoosePairs& loose = {});

/// The same, but the page names a triangle by its index in leaf.triangles.
Page build_page(const Soup& soup, const Leaf& leaf, BuildProgress* progress = nullptr,
                const LoosePairs& loose = {});

} // namespace ovc
