// SPDX-License-Identifier: Apache-2.0
// Takes the boxes of leaves, and opens the pages of these from the root down.
#include "plugin/ranks/page_boxes.h"

#include <algorithm>
#include <map>
#include <utility>

namespace ovc {
namespace {

Box box_around(const Level1& level1, const Leaf& leaf) {
    return leaf.box.padded(level1.padding + leaf.box.rounding());
}

/// A whole page, or a node of one that is placed once.
struct Node {
    static constexpr uint32_t kWhole = 0; // as the unit: the unit of the header

    PageBox at;
    uint32_t unit = kWhole;
};

/// Finds what lies below the nodes of the pages that are placed once.
class OpenedPages {
public:
    explicit OpenedPages(const BuiltScene& scene) : scene_(scene) {}

    /// Returns the children of a node; none where it cannot be opened.
    std::vector<Node> children(const Node& node) const {
        std::vector<Node> children;
        if (node.at.page >= scene_.level1.leaves.size())
            return children; // of a mesh with places
        const Page& page = scene_.pages[node.at.page];
        const uint32_t unit = node.unit == Node::kWhole ? OVC_ROOT_UNIT : node.unit;
        const size_t texel = size_t(unit) * OVC_UNIT_TEXELS;
        // Only the root of a page on a disk is here.
        if (page.view().size() < texel + OVC_UNIT_TEXELS || is_pair(page.view()[texel + 3]))
            return children;
        for (uint32_t child = 0; child < 4; ++child)
            if (const Box box = child_box(page, unit, child); !box.empty())
                children.push_back({{in_world(node.at.page, box), node.at.page},
                                    page.view()[texel + 3].x + child});
        return children;
    }

private:
    static bool is_pair(const uvec4& last_texel) { return (last_texel.w & OVC_PAIR) != 0; }

    Box in_world(uint32_t page, const Box& local) const {
        const Leaf& leaf = scene_.level1.leaves[page];
        const Frame& frame = leaf.frame;
        const Box box{local.lo / frame.scale + frame.origin, local.hi / frame.scale + frame.origin};
        // Corners were rounded to the frame's floats, which are finer than a cell of its grid.
        const double cell = max_component(leaf.grid.extent()) * 0x1p-16;
        const Box around = box_around(scene_.level1, leaf);
        return box.padded(cell + scene_.level1.padding + around.rounding()).intersection(around);
    }

    const BuiltScene& scene_;
};

/// Opens the largest of these nodes, as long as there are no more than `max`.
std::vector<PageBox> opened(const OpenedPages& pages, std::vector<Node> nodes, size_t max) {
    const auto is_smaller = [](const Node& a, const Node& b) {
        return a.at.box.half_area() < b.at.box.half_area();
    };
    std::ranges::make_heap(nodes, is_smaller);
    std::vector<Node> closed;
    while (!nodes.empty()) {
        std::ranges::pop_heap(nodes, is_smaller);
        const Node largest = nodes.back();
        nodes.pop_back();
        const std::vector<Node> children = pages.children(largest);
        if (children.empty() || nodes.size() + closed.size() + children.size() > max) {
            closed.push_back(largest);
            continue;
        }
        for (const Node& child : children) {
            nodes.push_back(child);
            std::ranges::push_heap(nodes, is_smaller);
        }
    }
    // Pages stand in the order of the KD-tree, and nodes in that of the page's tree.
    std::ranges::stable_sort(closed, {},
                             [](const Node& n) { return std::pair(n.at.page, n.unit); });
    std::vector<PageBox> boxes;
    for (const Node& node : closed)
        boxes.push_back(node.at);
    return boxes;
}

} // namespace

/// Returns all pages, in their order.
static std::vector<Node> whole_pages(const BuiltScene& scene) {
    std::vector<Node> pages;
    for (size_t i = 0; i < scene.level1.leaves.size(); ++i)
        pages.push_back({{box_around(scene.level1, scene.level1.leaves[i]), uint32_t(i)}});
    for (const SharedMesh& mesh : scene.shared)
        for (size_t i = 0; i < mesh.scene.level1.leaves.size(); ++i)
            for (const uint32_t place : mesh.places) {
                const Level1& level1 = mesh.scene.level1;
                // Leaves of a mesh at rest lie where it came to rest.
                const Box box = mesh.rest ? mesh.box : box_around(level1, level1.leaves[i]);
                pages.push_back({{placed_box(box, scene.soup.chunks[place].transform()),
                                  mesh.first_page + uint32_t(i)}});
            }
    return pages;
}

std::vector<PageBox> page_boxes(const BuiltScene& scene) {
    std::vector<PageBox> boxes;
    for (const Node& page : whole_pages(scene))
        boxes.push_back(page.at);
    return boxes;
}

std::vector<OwnedBox> owned_boxes(const BuiltScene& scene, std::span<const uint32_t> owners,
                                  size_t max) {
    std::map<uint32_t, std::vector<Node>> of_owner;
    for (const Node& page : whole_pages(scene))
        of_owner[owners[page.at.page]].push_back(page);
    const OpenedPages pages(scene);
    std::vector<OwnedBox> boxes;
    for (auto& [owner, whole] : of_owner) {
        const std::vector<PageBox> nodes = opened(pages, std::move(whole), max);
        const size_t group = (nodes.size() + max - 1) / max;
        for (size_t i = 0; i < nodes.size(); ++i) {
            if (i % group == 0)
                boxes.push_back({Box(), owner});
            boxes.back().box.add(nodes[i].box);
        }
    }
    return boxes;
}

} // namespace ovc
