// SPDX-License-Identifier: Apache-2.0
// Builds level 2: converts triangles to the leaf's frame, pairs them, builds a BVH, and packs it
// with four children a node and 16-bit boxes.
#include "gpu/page/page.h"

#include "core/system/parallel.h"
#include "gpu/bvh/bvh.h"
#include "gpu/bvh/loose_pairs.h"
#include "gpu/bvh/pairs.h"
#include "gpu/bvh/reinsert.h"
#include "gpu/page/grid.h"
#include "gpu/page/packer.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

constexpr size_t kTriangleGrain = 16384; // triangles, or pairs, a task

std::vector<LocalTriangle> local_triangles(const Soup& soup, const Leaf& leaf) {
    std::vector<LocalTriangle> triangles(leaf.triangles.size());
    parallel_for(triangles.size(), kTriangleGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Triangle world = soup.triangle(leaf.triangles[i]);
            for (int k = 0; k < 3; ++k)
                triangles[i][k] = vec3(leaf.frame.to_local(world[k]));
        }
    });
    return triangles;
}

void put_pair(const TrianglePair& pair, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
    const std::array<uint32_t, 4> w{pair.a, pair.b == kNone ? OVC_NO_TRIANGLE : pair.b, pair.order,
                                    OVC_PAIR};
    for (int i = 0; i < 4; ++i) {
        const vec3& c = pair.corners[i];
        unit[i] = {bits(c.x), bits(c.y), bits(c.z), w[i]};
    }
}

/// Returns how many pairs planes may cut in two: a tenth, so that a page stays within its planned
/// size, and never more units than if no two triangles made a pair. Loose pairs leave room for
/// more, which the plan foresees (plugin/plan/page_rate.h).
size_t max_cut(size_t pairs, size_t triangles, bool is_loose, const LoosePairs& loose) {
    return is_loose ? size_t(loose.max_cut() * double(pairs))
                    : std::min(pairs / 10, triangles - pairs);
}

/// The pairs that a page's units hold, under a BVH over the parts of them inside the leaf's box.
class PageItems {
public:
    /// name: maps an index into leaf.triangles to the page's name of the triangle.
    template <class Name>
    PageItems(const Soup& soup, const Leaf& leaf, BuildProgress* progress, const LoosePairs& loose,
              Name&& name)
        : pairs_(pair_triangles(local_triangles(soup, leaf), progress)),
          is_loose_(loose.allowed && worth_loosening(pairs_.size(), leaf.triangles.size())) {
        for (TrianglePair& pair : pairs_) {
            pair.a = name(pair.a);
            pair.b = pair.b == kNone ? kNone : name(pair.b);
        }
        const Box box{leaf.frame.to_local(leaf.box.lo), leaf.frame.to_local(leaf.box.hi)};
        nodes_ = build_split_bvh(boxes({vec3(box.lo), vec3(box.hi)}), pairs_,
                                 max_cut(pairs_.size(), leaf.triangles.size(), is_loose_, loose),
                                 progress);
        if (is_loose_)
            loose_ = join_loose(nodes_, pairs_);
        reinsert(nodes_, progress); // after joining, because fewer leaves take less time
        // Rounded last to the corners that the kernel sees: boxes are tighter without the rounding.
        for (TrianglePair& pair : pairs_)
            for (vec3& corner : pair.corners)
                corner = is_loose_ ? in_steps(corner) : corner;
    }

    const std::vector<BvhNode>& nodes() const { return nodes_; }
    bool is_loose() const { return is_loose_; }

    void put(uint32_t item, std::span<uvec4, OVC_UNIT_TEXELS> unit) const {
        if (item < pairs_.size())
            return put_pair(pairs_[item], unit);
        const auto [first, second] = loose_[item - pairs_.size()];
        put_loose(pairs_[first], pairs_[second], unit);
    }

private:
    /// Returns the pairs' boxes, clamped to the leaf's: hits count only inside it.
    std::vector<Boxf> boxes(const Boxf& inside) const {
        std::vector<Boxf> boxes(pairs_.size());
        parallel_for(boxes.size(), kTriangleGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                for (const vec3& corner : pairs_[i].corners)
                    boxes[i].add(corner);
                boxes[i] = {glm::clamp(boxes[i].lo, inside.lo, inside.hi),
                            glm::clamp(boxes[i].hi, inside.lo, inside.hi)};
            }
        });
        return boxes;
    }

    std::vector<TrianglePair> pairs_;
    const bool is_loose_;
    std::vector<BvhNode> nodes_;
    std::vector<LoosePair> loose_;
};

Page pack(const PageItems& items, const Leaf& leaf, BuildProgress* progress) {
    const Grid grid({leaf.frame.to_local(leaf.grid.lo), leaf.frame.to_local(leaf.grid.hi)});
    const auto put = [&](uint32_t item, std::span<uvec4, OVC_UNIT_TEXELS> unit) {
        items.put(item, unit);
    };
    Page page = Packer(items.nodes(), grid.header(), grid, put, progress).pack();
    page.texels[OVC_LOOSE_TEXEL].x = items.is_loose() ? OVC_HAS_LOOSE_PAIRS : 0;
    assert(page.texels.size() / OVC_UNIT_TEXELS < OVC_MAX_PAGE_UNITS);
    return page;
}

} // namespace

Page build_page(const Soup& soup, const Numbering& numbers, const Leaf& leaf,
                BuildProgress* progress, const LoosePairs& loose) {
    assert(!leaf.triangles.empty());
    const auto name = [&](uint32_t i) { return numbers.of(leaf.triangles[i]); };
    return pack(PageItems(soup, leaf, progress, loose, name), leaf, progress);
}

Page build_page(const Soup& soup, std::span<const uint32_t> numbers, const Leaf& leaf,
                BuildProgress* progress, const LoosePairs& loose) {
    assert(!leaf.triangles.empty() && numbers.size() == leaf.triangles.size());
    const auto name = [&](uint32_t i) { return numbers[i]; };
    return pack(PageItems(soup, leaf, progress, loose, name), leaf, progress);
}

Page build_page(const Soup& soup, const Leaf& leaf, BuildProgress* progress,
                const LoosePairs& loose) {
    assert(!leaf.triangles.empty());
    const auto name = [](uint32_t i) { return i; };
    return pack(PageItems(soup, leaf, progress, loose, name), leaf, progress);
}

Box child_box(const Page& page, uint32_t node, uint32_t child) {
    const auto words = page.view().subspan(size_t(node) * OVC_UNIT_TEXELS);
    const GridHeader grid = header_of(page.view());
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const GridRange range = range_of(words[size_t(axis)], child);
        if (range.empty())
            return Box();
        box.lo[axis] = grid.middle[axis] + (double(range.lo) - kGridMiddle) * grid.cell[axis];
        box.hi[axis] = grid.middle[axis] + (double(range.hi) - kGridMiddle) * grid.cell[axis];
    }
    return box;
}

Box box_of(const Page& page) {
    Box box;
    for (uint32_t child = 0; child < 4; ++child)
        box.add(child_box(page, OVC_ROOT_UNIT, child));
    return box;
}

uint32_t stack_depth(uint32_t depth) {
    // A ray needs at most one word a level, and the last word is on top of the stack, not in it.
    // The number is even, so that few programs serve all scenes.
    const uint32_t words = std::max(depth, 2u) - 1;
    return words + words % 2;
}

uint32_t stack_depth(std::span<const Page> pages) {
    uint32_t depth = 1;
    for (const Page& page : pages)
        depth = std::max(depth, page.depth);
    return stack_depth(depth);
}

} // namespace ovc
