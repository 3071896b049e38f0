// SPDX-License-Identifier: Apache-2.0
// Linked pages: a BVH over the roots of all pages, on the grid that they share.
#include "gpu/linked.h"

#include "gpu/node_boxes.h"
#include "gpu/packer.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace ovc {
namespace {

/// Boxes that are in grid coordinates already.
struct Counted {
    GridRange range(const Boxf& box, int axis) const {
        return {uint32_t(box.lo[axis]), uint32_t(box.hi[axis])};
    }
};

/// The box of all children of a page's root, in grid coordinates.
Boxf root_box(const Page& page) {
    Boxf box;
    for (int axis = 0; axis < 3; ++axis) {
        const uvec4& words = page.view()[OVC_ROOT_UNIT * OVC_UNIT_TEXELS + size_t(axis)];
        GridRange all; // a missing child has the greatest lo and the least hi
        for (size_t child = 0; child < 4; ++child) {
            const GridRange range = range_of(words, child);
            all = {std::min(all.lo, range.lo), std::max(all.hi, range.hi)};
        }
        box.lo[axis] = float(all.lo);
        box.hi[axis] = float(all.hi);
    }
    return box;
}

GridHeader header_of(const Page& page) {
    const auto vector = [&](size_t i) {
        const uvec4& t = page.view()[i];
        return vec3(std::bit_cast<float>(t.x), std::bit_cast<float>(t.y),
                    std::bit_cast<float>(t.z));
    };
    return {vector(0), vector(1)};
}

/// A tree over the boxes of all pages; put(leaf, unit) writes its lowest units.
template <class Put>
Page tree_over(std::span<const Page> pages, const Put& put) {
    std::vector<Boxf> boxes;
    for (const Page& page : pages)
        boxes.push_back(root_box(page));
    const std::vector<BvhNode> nodes = build_bvh(boxes, nullptr);
    return Packer(nodes, header_of(pages[0]), Counted(), put, nullptr).pack();
}

/// A triangle of a sample: where it is, and how much of it float32 leaves in doubt.
struct Patch {
    dvec3 center;
    double area;
    double doubtful; // of the area
};

/// The doubtful share of the area, of small neighbourhoods with as many patches each, added up over
/// the patches. Rays that come to a neighbourhood hit its triangles by their area; but a large
/// triangle far away says nothing about small ones here.
double sum_of_shares(std::span<Patch> patches) {
    constexpr size_t kNeighbours = 64;
    if (patches.size() <= kNeighbours) {
        double area = 0, doubtful = 0;
        for (const Patch& patch : patches) {
            area += patch.area;
            doubtful += patch.doubtful;
        }
        return area > 0 ? doubtful / area * double(patches.size()) : double(patches.size());
    }
    Box box;
    for (const Patch& patch : patches)
        box.add(patch.center);
    const int axis = major_axis(box.extent());
    const size_t half = patches.size() / 2;
    std::nth_element(
        patches.begin(), patches.begin() + ptrdiff_t(half), patches.end(),
        [axis](const Patch& a, const Patch& b) { return a.center[axis] < b.center[axis]; });
    return sum_of_shares(patches.first(half)) + sum_of_shares(patches.subspan(half));
}

} // namespace

double doubtful_share(const Soup& soup, std::span<const TriangleId> triangles, const Frame& frame) {
    constexpr size_t kSample = 4096;
    // Of a corner as far off as the frame is wide, its neighbours close to the ray.
    constexpr double kBound = OVC_BOUND_UNIT * (OVC_BOUND_CONSTANT + OVC_BOUND_RELATIVE);
    const size_t step = triangles.size() / kSample + 1;
    std::vector<Patch> patches;
    for (size_t i = 0; i < triangles.size(); i += step) {
        const Triangle t = soup.triangle(triangles[i]);
        const double around =
            glm::length(t[1] - t[0]) + glm::length(t[2] - t[1]) + glm::length(t[0] - t[2]);
        const double area = glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) / 2;
        const double band = kBound / frame.scale * around;
        patches.push_back({t[0] / 3.0 + t[1] / 3.0 + t[2] / 3.0, area, std::min(band, area)});
    }
    return patches.empty() ? 0 : sum_of_shares(patches) / double(patches.size());
}

bool one_frame_suits(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds) {
    return doubtful_share(soup, triangles, scene_leaf(bounds).frame) <= kMostDoubtful;
}

uint64_t most_linked_bytes(uint64_t level2_bytes, uint64_t leaves) {
    // A header, the pages' roots, and nodes of two children at least.
    return level2_bytes + (leaves > 1 ? (2 * leaves + 1) * OVC_UNIT_BYTES : 0);
}

std::optional<LinkedPages> link_pages(const Level1& level1, std::span<const Page> pages,
                                      uint64_t pool_bytes) {
    if (!level1.shares_frame || pages.empty())
        return {};
    LinkedPages linked;
    uint64_t units = 0;
    uint32_t deepest = 0;
    for (const Page& page : pages) {
        linked.first_unit.push_back(uint32_t(units));
        units += page.units();
        deepest = std::max(deepest, page.depth);
        if (units >= OVC_MAX_UNITS || units * OVC_UNIT_BYTES > pool_bytes)
            return {};
    }
    if (pages.size() == 1) { // is under a tree already
        linked.top_unit = 0;
        linked.depth = deepest;
    } else {
        linked.top_unit = uint32_t(units);
        const auto put = [&](uint32_t leaf, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
            const auto root =
                pages[leaf].view().subspan<OVC_ROOT_UNIT * OVC_UNIT_TEXELS, OVC_UNIT_TEXELS>();
            std::copy(root.begin(), root.end(), unit.begin());
            // Counted from the top's first unit, like its own.
            unit[3].x += linked.first_unit[leaf] - linked.top_unit;
            unit[3].y = leaf + 1;
        };
        linked.top = tree_over(pages, put);
        linked.depth = linked.top.depth + deepest;
    }
    units += linked.top.units();
    if (units >= OVC_MAX_UNITS || units * OVC_UNIT_BYTES > pool_bytes)
        return {};
    return linked;
}

std::optional<LinkTree> make_link_tree(const Level1& level1, std::span<const Page> pages,
                                       uint64_t pool_bytes) {
    if (!level1.shares_frame || pages.empty() || pages.size() >= OVC_KEY_LEAF ||
        pool_bytes / OVC_UNIT_BYTES >= uint64_t(OVC_MAX_UNITS))
        return {};
    LinkTree tree;
    uint64_t largest = 0;
    for (const Page& page : pages) {
        tree.depth = std::max(tree.depth, page.depth);
        largest = std::max(largest, page.bytes());
    }
    tree.top = tree_over(pages, [&](uint32_t leaf, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
        const Boxf box = root_box(pages[leaf]);
        for (int axis = 0; axis < 3; ++axis)
            for (size_t child = 0; child < 4; ++child)
                put_range(unit[size_t(axis)], child,
                          child == 0 ? Counted().range(box, axis) : GridRange());
        unit[3] = {OVC_LEADS_NOWHERE, leaf + 1, 0, 0};
    });
    tree.depth += tree.top.depth + 1;
    if (tree.top.bytes() + largest > pool_bytes)
        return {};
    tree.link_unit.resize(pages.size());
    for (uint32_t unit = OVC_ROOT_UNIT; unit < tree.top.units(); ++unit)
        if (const uint32_t leaf = tree.top.view()[size_t(unit) * OVC_UNIT_TEXELS + 3].y)
            tree.link_unit[leaf - 1] = unit;
    return tree;
}

void copy_relocated(const Page& page, uint32_t first_unit, std::span<uvec4> to, uint32_t owner) {
    constexpr size_t kGrain = 4096; // units a task
    const std::span<const uvec4> from = page.view();
    assert(to.size() == from.size());
    parallel_for(page.units(), kGrain, [&](size_t begin, size_t end) {
        for (size_t unit = begin; unit < end; ++unit) {
            const uvec4* const source = from.data() + unit * OVC_UNIT_TEXELS;
            uvec4* const texel = to.data() + unit * OVC_UNIT_TEXELS;
            texel[0] = source[0];
            texel[1] = source[1];
            texel[2] = source[2];
            uvec4 last = source[3];
            last.x += last.w & OVC_PAIR || unit < OVC_ROOT_UNIT ? 0 : first_unit;
            texel[3] = last;
        }
    });
    if (!from.empty())
        to[2].x = from[2].x + first_unit;
    if (owner != 0)
        to[OVC_ROOT_UNIT * OVC_UNIT_TEXELS + 3].y = owner;
}

} // namespace ovc
