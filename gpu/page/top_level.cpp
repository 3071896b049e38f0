// SPDX-License-Identifier: Apache-2.0
// Opens the largest nodes of the pages and builds a BVH over the nodes below them. Over several
// such trees it builds a BVH over the portals to them.
#include "gpu/page/top_level.h"

#include "core/system/parallel.h"
#include "gpu/bvh/reinsert.h"
#include "gpu/page/grid.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/open_nodes.h"
#include "gpu/page/packer.h"
#include "gpu/page/portal_boxes.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>

namespace ovc {
namespace {

/// The grid on which the boxes of entries, and unions of them, lie exactly.
struct Cells {
    vec3 size;

    GridRange range(const Boxf& box, int axis) const {
        return {uint32_t(std::lround(box.lo[axis] / size[axis])),
                uint32_t(std::lround(box.hi[axis] / size[axis]))};
    }
};

/// Builds a BVH over the entries, whose leaf i has item i.
Page tree_over(std::span<const Page> pages, std::span<const Entry> entries) {
    std::vector<Boxf> boxes;
    for (const Entry& entry : entries)
        boxes.push_back(entry.box);
    std::vector<BvhNode> nodes = build_bvh(boxes, nullptr);
    reinsert(nodes, nullptr, kThorough);
    const auto put = [&](uint32_t i, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
        std::ranges::copy(unit_of(pages[entries[i].page], entries[i].unit), unit.begin());
        if (!is_pair(pages[entries[i].page], entries[i].unit))
            unit[3] = {i, 1, 0, 0}; // a mark by which build_top_level() finds it again
    };
    return Packer(nodes, header_of(pages[0].view()), Cells{header_of(pages[0].view()).cell}, put,
                  nullptr)
        .pack();
}

/// Makes the root of the only page the tree's root.
Page tree_of_one(const Page& page) {
    Page tree;
    tree.depth = 0;
    const auto units = page.view().first(kHeadTexels);
    tree.texels.assign(units.begin(), units.end());
    tree.texels[OVC_ROOT_UNIT * OVC_UNIT_TEXELS + 3] = {0, 1, 0, 0}; // as in tree_over()
    return tree;
}

/// The boxes of a portal's node, in the frame of the scene.
using PortalBoxes = std::array<Boxf, PartOutline::kGroups>;

PortalBoxes boxes_in(const Frame& frame, const PartOutline::Groups& groups) {
    PortalBoxes boxes;
    for (size_t i = 0; i < groups.size(); ++i)
        if (!groups[i].empty())
            boxes[i] = {vec3(frame.to_local(groups[i].lo)), vec3(frame.to_local(groups[i].hi))};
    return boxes;
}

/// Builds a BVH over portals; its leaf i is portal number i + 1.
Page tree_over(std::span<const PortalBoxes> portals, const Leaf& scene) {
    std::vector<Boxf> boxes;
    for (const PortalBoxes& groups : portals) {
        Boxf all;
        for (const Boxf& box : groups)
            all.add(box);
        boxes.push_back(all);
    }
    std::vector<BvhNode> nodes = build_bvh(boxes, nullptr);
    reinsert(nodes, nullptr, kThorough);
    const Grid grid({scene.frame.to_local(scene.grid.lo), scene.frame.to_local(scene.grid.hi)});
    const auto put = [&](uint32_t i, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
        for (int axis = 0; axis < 3; ++axis)
            for (size_t child = 0; child < 4; ++child) {
                const Boxf& box = portals[i][child];
                put_range(unit[size_t(axis)], child,
                          box.empty() ? GridRange() : grid.range(box, axis));
            }
        unit[3] = {~i, 0, 0, 0}; // -(i + 1)
    };
    return Packer(nodes, grid.header(), grid, put, nullptr).pack();
}

/// Says that pages before this one have no links, as far as none were added.
void skip_to_page(TopLevel& top, size_t page) {
    top.first_link.resize(page + 1, uint32_t(top.links.size()));
}

/// Appends the tree of the part whose pages begin with `first_page`; returns where it begins.
uint32_t append(TopLevel& top, const TopLevel& part, uint32_t first_page) {
    skip_to_page(top, first_page);
    const auto begin = uint32_t(top.tree.units());
    top.tree.texels.resize(top.tree.texels.size() + part.tree.texels.size());
    const auto to = std::span(top.tree.texels).last(part.tree.texels.size());
    copy_relocated(part.tree.view(), begin, to);
    for (const Link& link : part.links) {
        to[size_t(link.unit) * OVC_UNIT_TEXELS + 3].y += first_page;
        top.links.push_back({begin + link.unit, link.first_child});
    }
    for (size_t page = 1; page < part.first_link.size(); ++page)
        top.first_link.push_back(top.first_link[first_page] + part.first_link[page]);
    top.depth = std::max(top.depth, part.depth);
    return begin;
}

/// Builds the tree over the pages of one part, in its frame.
TopLevel tree_of_part(const LeafRange& part, std::span<const Page> pages, size_t max_links) {
    TopLevel own = build_top_level(pages.subspan(part.first, part.count),
                                   std::max<size_t>(max_links, part.count));
    if (part.count == pages.size())
        return own;
    TopLevel top;
    append(top, own, part.first);
    skip_to_page(top, pages.size());
    return top;
}

} // namespace

TopLevel build_top_level(std::span<const Page> pages, size_t max_links) {
    assert(!pages.empty() && max_links >= pages.size());
    TopLevel top;
    std::vector<Entry> entries;
    if (pages.size() == 1) {
        entries = {root_of(pages, 0)};
        top.tree = tree_of_one(pages[0]);
    } else {
        entries = opened(pages, max_links);
        top.tree = tree_over(pages, entries);
    }
    std::vector<uint32_t> unit_of_entry(entries.size());
    for (uint32_t unit = OVC_ROOT_UNIT; unit < top.tree.units(); ++unit) {
        uvec4& words = top.tree.texels[size_t(unit) * OVC_UNIT_TEXELS + 3];
        if ((words.w & OVC_PAIR) || words.y == 0)
            continue;
        const Entry& entry = entries[words.x];
        unit_of_entry[words.x] = unit;
        words = {OVC_LEADS_NOWHERE, entry.page + 1, first_child(pages, entry), 0};
    }
    top.first_link.resize(pages.size() + 1);
    for (size_t i = 0; i < entries.size(); ++i)
        if (!is_pair(pages[entries[i].page], entries[i].unit)) {
            top.links.push_back({unit_of_entry[i], first_child(pages, entries[i])});
            top.first_link[entries[i].page + 1] = uint32_t(top.links.size());
        }
    for (size_t page = 0; page < pages.size(); ++page) // a page may have no links
        top.first_link[page + 1] = std::max(top.first_link[page + 1], top.first_link[page]);
    for (const Page& page : pages)
        top.depth = std::max(top.depth, page.depth);
    top.depth += top.tree.depth;
    return top;
}

TopLevel build_top_level(const Level1& level1, std::span<const Page> pages, size_t max_links,
                         std::span<const uint32_t> without) {
    Parts parts;
    parts.add(level1, 0, {Place()}, without);
    if (parts.all.empty())
        return {};
    if (parts.all.size() > 1)
        return build_top_level(level1.bounds, parts, pages, max_links);
    TopLevel top = tree_of_part(parts.all[0].pages, pages, max_links);
    const Leaf& leaf = level1.leaves[parts.all[0].pages.first];
    if (!parts.has_all || !(leaf.frame == scene_leaf(level1.bounds).frame)) // there were others
        top.scene = Leaf{.cell = {}, .box = leaf.grid, .frame = leaf.frame, .grid = leaf.grid};
    return top;
}

void Parts::add(const Level1& level1, uint32_t first_page, const std::vector<Place>& places,
                std::span<const uint32_t> without) {
    for (const LeafRange& part : parts_of(level1)) {
        if (std::ranges::binary_search(without, part.first)) {
            assert(part.count == 1);
            has_all = false;
            continue;
        }
        const Leaf& leaf = level1.leaves[part.first];
        all.push_back({{first_page + part.first, part.count}, leaf.frame, leaf.grid, places, {}});
    }
}

namespace {

/// Returns the portals into a part.
std::vector<Portal> portals_into(const PlacedPart& part) {
    std::vector<Portal> portals;
    for (const Place& place : part.places) {
        portals.push_back(portal_into(part.frame, part.box, place.transform));
        portals.back().first_number = place.first_number;
    }
    return portals;
}

Box bounds_of(std::span<const Portal> portals) {
    Box all;
    for (const Portal& portal : portals)
        all.add(portal.bounds);
    return all;
}

/// Returns the boxes of the nodes of a part's portals.
std::vector<PortalBoxes> boxes_of_portals(const PlacedPart& part, std::span<const Page> pages,
                                          const Frame& scene) {
    constexpr size_t kGrain = 64; // portals a task
    const PartOutline outline(pages.subspan(part.pages.first, part.pages.count));
    std::vector<PortalBoxes> boxes(part.places.size());
    parallel_for(boxes.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            boxes[i] = boxes_in(scene, outline.placed(part.frame, part.places[i].transform));
    });
    return boxes;
}

} // namespace

TopLevel build_top_level(const Box& bounds, const Parts& parts, std::span<const Page> pages,
                         size_t max_links) {
    assert(!parts.all.empty());
    std::vector<Portal> portals;
    for (const PlacedPart& part : parts.all)
        std::ranges::move(portals_into(part), std::back_inserter(portals));
    const Leaf scene = scene_leaf(parts.has_all ? bounds : bounds_of(portals));
    TopLevel top;
    if (portals.size() == 1 && portals[0].first_number == 0) {
        top = tree_of_part(parts.all[0].pages, pages, max_links);
        top.way_in = portals[0];
        if (!parts.has_all)
            top.scene = scene;
        return top;
    }
    if (!parts.has_all)
        top.scene = scene;
    std::vector<PortalBoxes> boxes;
    for (const PlacedPart& part : parts.all)
        std::ranges::move(boxes_of_portals(part, pages, scene.frame), std::back_inserter(boxes));
    top.tree = tree_over(boxes, scene);
    const uint32_t depth = top.tree.depth;
    auto portal = portals.begin();
    for (const PlacedPart& part : parts.all) {
        const auto& [first, count] = part.pages;
        const size_t links = std::max<size_t>(max_links * count / pages.size(), count);
        const uint32_t begin =
            append(top, build_top_level(pages.subspan(first, count), links), first);
        for (size_t i = 0; i < part.places.size(); ++i)
            (portal++)->tree = begin;
    }
    skip_to_page(top, pages.size());
    top.portals = {portal_into(scene.frame, scene.box)};
    top.portals.insert(top.portals.end(), portals.begin(), portals.end());
    top.depth += depth + 1; // and the word by which a ray comes back
    return top;
}

bool is_usable(const TopLevel& top, std::span<const Page> pages, const PoolLayout& pool) {
    const uint64_t tree = top.room();
    if (top.empty() || pool.bytes == 0 || tree > pool.bytes_of(0))
        return false;
    const uint64_t beside = pool.bytes_of(0) - tree;
    const uint64_t room = pool.count() > 1 ? std::max(beside, pool.bytes_of(1)) : beside;
    return largest_bytes(pages) <= room &&
           (pages.size() < OVC_KEY_LEAF || all_fit(pages, pool, tree));
}

void copy_relocated(std::span<const uvec4> from, uint32_t first_unit, std::span<uvec4> to) {
    constexpr size_t kUnitGrain = 4096; // units a task
    assert(to.size() == from.size());
    parallel_for(from.size() / OVC_UNIT_TEXELS, kUnitGrain, [&](size_t begin, size_t end) {
        for (size_t unit = begin; unit < end; ++unit) {
            const uvec4* const source = from.data() + unit * OVC_UNIT_TEXELS;
            uvec4* const texel = to.data() + unit * OVC_UNIT_TEXELS;
            texel[0] = source[0];
            texel[1] = source[1];
            texel[2] = source[2];
            uvec4 last = source[3];
            const bool is_link = last.y != 0; // in the tree of a part
            last.x += last.w & OVC_PAIR || unit < OVC_ROOT_UNIT || is_link ? 0 : first_unit;
            texel[3] = last;
        }
    });
    if (!from.empty())
        to[2].x = from[2].x + first_unit;
}

} // namespace ovc
