// SPDX-License-Identifier: Apache-2.0
// Linked pages: all pages of a scene in the pool at once, under one tree. A ray is traced in one
// frame from the scene's root down, and level 1 costs it nothing. Shared by all leaves, the frame
// must suit them: the smaller the triangles in it, the more rays float32 leaves in doubt.
#pragma once

#include "gpu/page.h"
#include "kdtree/partition.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// What of the rays that hit the triangles float32 would leave in doubt in the frame, roughly: the
/// share of the area, in small neighbourhoods all over the scene, that lies within the error bound
/// of the triangles' sides (docs/numerics.md). It looks at a sample.
double doubtful_share(const Soup& soup, std::span<const TriangleId> triangles, const Frame& frame);

/// Up to this share a frame suits all leaves.
inline constexpr double kMostDoubtful = 1.0 / 8;

/// Whether the frame of a scene in `bounds` suits all its leaves.
bool one_frame_suits(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// Where linked pages lie: one behind the other from the pool's first byte on, `top` behind them.
struct LinkedPages {
    std::vector<uint32_t> first_unit; // of the pool, per page
    Page top;              // nodes over the pages, the lowest copies of their roots; none for one
    uint32_t top_unit = 0; // where a traversal begins
    uint32_t depth = 0;    // nodes on the longest way down
    uint64_t moved = 0;    // pages in the pool
};

/// Where not all pages are in the pool: a tree that lies at its first unit, whose lowest nodes are
/// links to pages (shaders/layout.h). A ray meets them by t, and waits for those that lead nowhere.
struct LinkTree {
    Page top;
    std::vector<uint32_t> link_unit; // of the pool, per page
    uint32_t depth = 0;              // nodes on the longest way down
};

/// Bytes that linked pages of `level2_bytes` take in the pool, at most.
uint64_t most_linked_bytes(uint64_t level2_bytes, uint64_t leaves);

/// The pages of leaves that share a frame, linked; none where the pool has no room for all or their
/// units cannot be counted in a stack word.
std::optional<LinkedPages> link_pages(const Level1& level1, std::span<const Page> pages,
                                      uint64_t pool_bytes);

/// The tree, all its links leading nowhere; none where leaves do not share a frame or are more than
/// a key can name, the pool has no room for the largest page beside it, or its units cannot be
/// counted in a stack word.
std::optional<LinkTree> make_link_tree(const Level1& level1, std::span<const Page> pages,
                                       uint64_t pool_bytes);

/// Writes a page as it must be where it begins at `first_unit` and units count from the pool's
/// first; on all cores. to: as large as the page. owner: of a linked page, which its root then says
/// (leaf + 1).
void copy_relocated(const Page& page, uint32_t first_unit, std::span<uvec4> to, uint32_t owner = 0);

} // namespace ovc
