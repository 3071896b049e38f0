// SPDX-License-Identifier: Apache-2.0
// Keeps the nodes in a heap by the areas of their boxes.
#include "gpu/page/open_nodes.h"

#include "gpu/page/node_boxes.h"

#include <algorithm>
#include <utility>

namespace ovc {

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
static void for_each_child(std::span<const Page> pages, uint32_t page, uint32_t node,
                           Visit&& visit) {
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

} // namespace ovc
