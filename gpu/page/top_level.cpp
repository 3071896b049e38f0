// SPDX-License-Identifier: Apache-2.0
// Opens the largest nodes of the pages and builds a BVH over the nodes below them. Over several
// such trees it builds a BVH over the portals to them.
#include "gpu/page/top_level.h"

#include "gpu/bvh/reinsert.h"
#include "gpu/page/grid.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/packer.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace ovc {
namespace {

/// A unit of a page, and its box in cells of the grid, each cell as large as it is in the frame.
struct Entry {
    uint32_t page;
    uint32_t unit;
    Boxf box;
};

std::span<const uvec4, OVC_UNIT_TEXELS> unit_of(const Page& page, uint32_t unit) {
    return page.view().subspan(size_t(unit) * OVC_UNIT_TEXELS).first<OVC_UNIT_TEXELS>();
}

bool is_pair(const Page& page, uint32_t unit) {
    return (unit_of(page, unit)[3].w & OVC_PAIR) != 0;
}

uint32_t first_child(std::span<const Page> pages, const Entry& node) {
    return unit_of(pages[node.page], node.unit)[3].x;
}

/// Calls visit(entry) for each child of a node.
template <class Visit>
void for_each_child(std::span<const Page> pages, uint32_t page, uint32_t node, Visit&& visit) {
    const auto words = unit_of(pages[page], node);
    const vec3 cell = header_of(pages[page].view()).cell;
    for (uint32_t child = 0; child < 4; ++child) {
        Entry entry{page, words[3].x + child, {}};
        for (int axis = 0; axis < 3; ++axis) {
            const GridRange range = range_of(words[size_t(axis)], child);
            entry.box.lo[axis] = float(range.lo) * cell[axis];
            entry.box.hi[axis] = float(range.hi) * cell[axis];
        }
        if (!entry.box.empty())
            visit(entry);
    }
}

Entry root_of(std::span<const Page> pages, uint32_t page) {
    Entry root{page, OVC_ROOT_UNIT, {}};
    for_each_child(pages, page, OVC_ROOT_UNIT,
                   [&](const Entry& child) { root.box.add(child.box); });
    return root;
}

/// Returns the roots of all pages, but replaces the largest nodes by their children, again and
/// again, as long as there are no more than `max` entries. Based on: Benthin, Woop, Wald and Afra
/// 2017, "Improved Two-Level BVHs using Partial Re-Braiding".
std::vector<Entry> opened(std::span<const Page> pages, size_t max) {
    const auto smaller = [](const Entry& a, const Entry& b) {
        return a.box.half_area() < b.box.half_area();
    };
    std::vector<Entry> nodes, pairs;
    for (uint32_t page = 0; page < pages.size(); ++page)
        nodes.push_back(root_of(pages, page));
    std::ranges::make_heap(nodes, smaller);
    while (!nodes.empty() && nodes.size() + pairs.size() + 3 <= max) {
        std::ranges::pop_heap(nodes, smaller);
        const Entry largest = nodes.back();
        nodes.pop_back();
        for_each_child(pages, largest.page, largest.unit, [&](const Entry& child) {
            if (is_pair(pages[child.page], child.unit)) {
                pairs.push_back(child);
                return;
            }
            nodes.push_back(child);
            std::ranges::push_heap(nodes, smaller);
        });
    }
    nodes.insert(nodes.end(), pairs.begin(), pairs.end());
    std::ranges::sort(nodes, {}, [](const Entry& e) { return std::pair(e.page, e.unit); });
    return nodes;
}

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

/// Builds a BVH over the portals' boxes in the world; its leaf i is portal number i + 1.
Page tree_over(std::span<const Portal> portals, const Leaf& scene) {
    std::vector<Boxf> boxes;
    for (const Portal& portal : portals)
        boxes.push_back({vec3(scene.frame.to_local(portal.bounds.lo)),
                         vec3(scene.frame.to_local(portal.bounds.hi))});
    std::vector<BvhNode> nodes = build_bvh(boxes, nullptr);
    reinsert(nodes, nullptr, kThorough);
    const Grid grid({scene.frame.to_local(scene.grid.lo), scene.frame.to_local(scene.grid.hi)});
    const auto put = [&](uint32_t i, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
        for (int axis = 0; axis < 3; ++axis)
            for (size_t child = 0; child < 4; ++child)
                put_range(unit[size_t(axis)], child,
                          child == 0 ? grid.range(boxes[i], axis) : GridRange());
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
    parts.add(level1, 0, std::array{Place()}, without);
    if (parts.pages.empty())
        return {};
    if (parts.pages.size() > 1)
        return build_top_level(level1.bounds, std::move(parts), pages, max_links);
    TopLevel top = tree_of_part(parts.pages[0], pages, max_links);
    const Leaf& leaf = level1.leaves[parts.pages[0].first];
    if (!parts.has_all || !(leaf.frame == scene_leaf(level1.bounds).frame)) // there were others
        top.scene = Leaf{.cell = {}, .box = leaf.grid, .frame = leaf.frame, .grid = leaf.grid};
    return top;
}

void Parts::add(const Level1& level1, uint32_t first_page, std::span<const Place> places,
                std::span<const uint32_t> without) {
    for (const LeafRange& part : parts_of(level1)) {
        if (std::ranges::binary_search(without, part.first)) {
            assert(part.count == 1);
            has_all = false;
            continue;
        }
        const Leaf& leaf = level1.leaves[part.first];
        std::vector<Portal> into;
        for (const Place& place : places) {
            into.push_back(portal_into(leaf.frame, leaf.grid, place.transform));
            into.back().first_number = place.first_number;
        }
        add({first_page + part.first, part.count}, into);
    }
}

Box Parts::bounds() const {
    Box all;
    for (const Portal& portal : portals)
        all.add(portal.bounds);
    return all;
}

void Parts::add(LeafRange part, std::span<const Portal> into) {
    for (const Portal& portal : into) {
        portals.push_back(portal);
        portals.back().tree = uint32_t(pages.size());
    }
    pages.push_back(part);
}

TopLevel build_top_level(const Box& bounds, Parts parts, std::span<const Page> pages,
                         size_t max_links) {
    assert(!parts.pages.empty() && parts.portals.size() >= parts.pages.size());
    const Leaf scene = scene_leaf(parts.has_all ? bounds : parts.bounds());
    TopLevel top;
    if (parts.portals.size() == 1 && parts.portals[0].first_number == 0) {
        top = tree_of_part(parts.pages[0], pages, max_links);
        top.way_in = parts.portals[0];
        if (!parts.has_all)
            top.scene = scene;
        return top;
    }
    if (!parts.has_all)
        top.scene = scene;
    top.tree = tree_over(parts.portals, scene);
    const uint32_t depth = top.tree.depth;
    std::vector<uint32_t> begins;
    for (const auto& [first, count] : parts.pages) {
        const size_t links = std::max<size_t>(max_links * count / pages.size(), count);
        begins.push_back(append(top, build_top_level(pages.subspan(first, count), links), first));
    }
    for (Portal& portal : parts.portals) {
        assert(portal.tree < begins.size());
        portal.tree = begins[portal.tree];
    }
    skip_to_page(top, pages.size());
    top.portals = {portal_into(scene.frame, scene.box)};
    top.portals.insert(top.portals.end(), parts.portals.begin(), parts.portals.end());
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
