// SPDX-License-Identifier: Apache-2.0
// The top-level tree: a tree over all pages of a scene, which a ray goes through first. It is
// always in the pool. If pages share a frame, the tree lies in it and its lowest units are copies
// of units of the pages, so a ray goes straight on into a page that is resident. Otherwise they are
// portals into frames, and such a tree lies behind each of them.
#pragma once

#include "gpu/frame/portal.h"
#include "gpu/page/page.h"
#include "gpu/page/residency.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// A unit of the top-level tree that is a copy of a page's node. The node's children lie in the
/// page.
struct Link {
    uint32_t unit;        // of the top-level tree
    uint32_t first_child; // of the page
};

struct TopLevel {
    Page tree;                   // all its links lead nowhere; the trees of parts follow
    std::vector<Portal> portals; // [0]: the way back; none if all pages share a frame
    /// The box around all that the tree leads to, and the frame in which rays set out; none if they
    /// are those of the whole scene.
    std::optional<Leaf> scene;
    std::optional<Portal> way_in;     // into the frame that all pages share, if they are placed
    std::vector<Link> links;          // those of one page lie together
    std::vector<uint32_t> first_link; // for each page, and one past the last of all
    uint32_t depth = 0;               // nodes on the longest way down, pages included
    uint64_t spare_bytes = 0;         // behind it in the pool, for a larger one after an update
    size_t max_portals = 0;           // if more than there are: room in their table, likewise

    /// Returns the bytes of the pool that no page lies in.
    uint64_t room() const { return tree.bytes() + spare_bytes; }
    /// Returns the bytes of the table of portals, and of the part of it that is used.
    uint64_t table_bytes() const { return std::max(portals.size(), max_portals) * kPortalBytes; }
    uint64_t used_table_bytes() const { return portals.size() * kPortalBytes; }
    bool empty() const { return tree.texels.empty(); }
    /// Returns `scene`, or that of all in `bounds`.
    Leaf scene_in(const Box& bounds) const { return scene ? *scene : scene_leaf(bounds); }
    std::span<const Link> links_of(uint32_t page) const {
        assert(page + size_t(1) < first_link.size());
        return std::span(links).subspan(first_link[page], first_link[page + 1] - first_link[page]);
    }
};

/// How many links a page has on average if all pages are resident: the builder opens large nodes,
/// so that the tree can choose anew which nodes lie together (docs/decisions/0026). With 16, the
/// kernel takes 4 % longer for camera rays at plants-2 in 136 leaves.
inline constexpr uint64_t kLinksPerPage = 8;

/// The max bytes of a tree with so many links if all pages share a frame.
inline uint64_t max_top_level_bytes(uint64_t links) {
    return ((links > 1 ? 2 * links : 0) + OVC_ROOT_UNIT + 1) * OVC_UNIT_BYTES;
}

/// Returns about how many bytes it takes over pages of `page_bytes` in all: their units are pairs
/// and two nodes for five of these, and links are not more than the pairs.
inline uint64_t expected_top_level_bytes(uint64_t links, uint64_t page_bytes) {
    const uint64_t entries = std::min(links, page_bytes * 5 / (7 * OVC_UNIT_BYTES));
    return std::min(max_top_level_bytes(entries),
                    (entries * 7 / 5 + OVC_ROOT_UNIT + 1) * OVC_UNIT_BYTES);
}

/// The max bytes that each page adds to the tree and the table of portals if each has a frame of
/// its own: a portal, a header, a link, an inner node and an entry of the table.
inline constexpr uint64_t kMaxBytesPerPart = 4 * OVC_UNIT_BYTES + kPortalBytes;

/// Returns how many links the tree over pages of `page_bytes` in all may have. It is one a page if
/// the pool has no room for all, because a ray that comes to a page by several links may wait for
/// it more than once.
inline uint64_t max_links(uint64_t pages, uint64_t page_bytes, uint64_t pool_bytes) {
    const uint64_t links = pages > 1 ? kLinksPerPage * pages : 1;
    return page_bytes + max_top_level_bytes(links) <= pool_bytes ? links : pages;
}

/// Builds the tree over at least one page; the pages share a frame and a grid for their boxes.
/// max_links: at least the number of pages. Pairs that would be links count as links, but lie in
/// the tree themselves.
TopLevel build_top_level(std::span<const Page> pages, size_t max_links);

/// Builds the tree over any number of pages, in the frames of their leaves. Neighbours that share a
/// frame are a part. without: the leaves, sorted, to whose pages it does not lead.
TopLevel build_top_level(const Level1& level1, std::span<const Page> pages, size_t max_links,
                         std::span<const uint32_t> without = {});

/// Where a mesh lies, and the number from which its triangles count there.
struct Place {
    const Transform* transform = nullptr;
    uint32_t first_number = 0;
};

/// Pages that share a frame, and where they lie in the world.
struct PlacedPart {
    LeafRange pages;
    Frame frame;
    Box box; // around all that the pages hold, before it is placed
    std::vector<Place> places;
    std::vector<Transform> kept; // transforms of places that nothing else keeps
};

struct Parts {
    std::vector<PlacedPart> all;
    bool has_all = true; // no leaf was left out

    /// Adds the parts of a level 1 whose pages begin with `first_page`, in all its places. without:
    /// leaves, sorted, that are parts by themselves and are left out.
    void add(const Level1& level1, uint32_t first_page, const std::vector<Place>& places,
             std::span<const uint32_t> without = {});
};

/// Builds the tree over parts, with a portal into each place of each. A part that is alone, and
/// whose triangles count from 0, has the tree in its frame. bounds: of the whole scene.
TopLevel build_top_level(const Box& bounds, const Parts& parts, std::span<const Page> pages,
                         size_t max_links);

/// Whether rays can go through the tree in a pool: the tree fits the first buffer, the largest page
/// fits some buffer, and if not all pages fit at once, a key can name every leaf.
bool is_usable(const TopLevel& top, std::span<const Page> pages, const PoolLayout& pool);

/// Writes a page for a place in the pool that begins at `first_unit`, so that its units count from
/// the pool's first; on all cores. to: as large as the page.
void copy_relocated(std::span<const uvec4> page, uint32_t first_unit, std::span<uvec4> to);

} // namespace ovc
