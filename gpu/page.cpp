// SPDX-License-Identifier: Apache-2.0
// Level 2: triangles into the leaf's frame, pairs, BVH, four children a node, 16-bit boxes.
#include "gpu/page.h"

#include "gpu/bvh.h"
#include "gpu/pairs.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

uint32_t bits(float x) {
    return std::bit_cast<uint32_t>(x);
}

std::vector<LocalTriangle> local_triangles(const Soup& soup, const Leaf& leaf) {
    std::vector<LocalTriangle> triangles(leaf.triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
        const Triangle world = soup.triangle(leaf.triangles[i]);
        for (int k = 0; k < 3; ++k)
            triangles[i][k] = vec3(leaf.frame.to_local(world[k]));
    }
    return triangles;
}

/// The 16-bit grid over a leaf's box.
class Grid {
public:
    explicit Grid(const Box& box) {
        for (int axis = 0; axis < 3; ++axis) {
            // Two cells of margin on each side: there the padding below has room.
            const double cell = std::max(box.extent()[axis], 1e-30) / (kLast - 4);
            cell_[axis] = std::nextafter(float(cell), INFINITY);
            org_[axis] = float(box.lo[axis] - 2 * double(cell_[axis]));
        }
    }

    const vec3& org() const { return org_; }
    const vec3& cell() const { return cell_; }

    /// lo and hi of `box` along an axis, rounded outwards by a tenth of a cell at least: 1/655,350
    /// of the leaf, 50 float roundings, where the kernel makes 25 at most (docs/numerics.md).
    uint32_t lo(const Boxf& box, int axis) const {
        return uint32_t(
            std::clamp(std::floor(position(box.lo[axis], axis) - kPadding), 0.0, kLast));
    }
    uint32_t hi(const Boxf& box, int axis) const {
        return uint32_t(std::clamp(std::ceil(position(box.hi[axis], axis) + kPadding), 0.0, kLast));
    }

private:
    static constexpr double kLast = 65535;
    static constexpr double kPadding = 0.1;

    double position(float x, int axis) const {
        return (double(x) - double(org_[axis])) / double(cell_[axis]);
    }

    vec3 org_;
    vec3 cell_;
};

class Packer {
public:
    Packer(const std::vector<BvhNode>& nodes, const std::vector<TrianglePair>& pairs,
           const Grid& grid, BuildProgress* progress)
        : nodes_(nodes), pairs_(pairs), grid_(grid), progress_(progress) {}

    Page pack() {
        add_units(1 + 1);
        unit(0)[0] = {bits(grid_.org().x), bits(grid_.org().y), bits(grid_.org().z), 0};
        unit(0)[1] = {bits(grid_.cell().x), bits(grid_.cell().y), bits(grid_.cell().z), 0};
        unit(0)[2] = {OVC_ROOT_UNIT, 0xffffffffu, 0, 0};
        unit(0)[3] = uvec4(0);
        // Even a single pair gets a node above it, so that its box is tested.
        pending_.push_back({0, OVC_ROOT_UNIT, 1});
        LoopProgress loop(progress_);
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            page_.depth = std::max(page_.depth, next.depth);
            pack_node(next);
            loop.step();
        }
        loop.finish();
        return std::move(page_);
    }

private:
    struct Pending {
        uint32_t node; // of the BVH
        uint32_t unit;
        uint32_t depth;
    };

    uvec4* unit(uint32_t index) { return &page_.texels[size_t(index) * OVC_UNIT_TEXELS]; }

    uint32_t add_units(uint32_t count) {
        const size_t first = page_.texels.size() / OVC_UNIT_TEXELS;
        page_.texels.resize(page_.texels.size() + size_t(count) * OVC_UNIT_TEXELS, uvec4(0));
        return uint32_t(first);
    }

    /// Up to four descendants that together hold the node's boxes: the widest inner one is opened
    /// until four are found.
    int children(uint32_t node, std::array<uint32_t, 4>& found) const {
        if (nodes_[node].is_leaf()) {
            found[0] = node;
            return 1;
        }
        int count = 2;
        found[0] = node + 1;
        found[1] = nodes_[node].right;
        while (count < 4) {
            int widest = -1;
            float area = -1;
            for (int i = 0; i < count; ++i) {
                const BvhNode& n = nodes_[found[i]];
                if (!n.is_leaf() && n.box.half_area() > area) {
                    area = n.box.half_area();
                    widest = i;
                }
            }
            if (widest < 0)
                break;
            const uint32_t opened = found[widest];
            found[widest] = opened + 1;
            found[count++] = nodes_[opened].right;
        }
        return count;
    }

    void pack_node(const Pending& at) {
        std::array<uint32_t, 4> child;
        const int count = children(at.node, child);
        const uint32_t base = add_units(uint32_t(count));
        for (int axis = 0; axis < 3; ++axis) {
            std::array<uint32_t, 4> lo{0xffff, 0xffff, 0xffff, 0xffff};
            std::array<uint32_t, 4> hi{0, 0, 0, 0};
            for (int i = 0; i < count; ++i) {
                lo[i] = grid_.lo(nodes_[child[i]].box, axis);
                hi[i] = grid_.hi(nodes_[child[i]].box, axis);
            }
            unit(at.unit)[axis] = {lo[0] | lo[1] << 16, lo[2] | lo[3] << 16, hi[0] | hi[1] << 16,
                                   hi[2] | hi[3] << 16};
        }
        unit(at.unit)[3] = {base, 0, 0, 0};
        for (int i = 0; i < count; ++i) {
            const BvhNode& node = nodes_[child[i]];
            if (node.is_leaf())
                pack_pair(pairs_[node.item], base + uint32_t(i));
            else
                pending_.push_back({child[i], base + uint32_t(i), at.depth + 1});
        }
    }

    void pack_pair(const TrianglePair& pair, uint32_t index) {
        const std::array<uint32_t, 4> w{pair.a, pair.b == kNone ? OVC_NO_TRIANGLE : pair.b,
                                        pair.order, OVC_PAIR};
        for (int i = 0; i < 4; ++i) {
            const vec3& c = pair.corners[i];
            unit(index)[i] = {bits(c.x), bits(c.y), bits(c.z), w[i]};
        }
    }

    const std::vector<BvhNode>& nodes_;
    const std::vector<TrianglePair>& pairs_;
    const Grid& grid_;
    BuildProgress* progress_;
    Page page_;
    std::vector<Pending> pending_;
};

/// name: index into leaf.triangles -> what the page calls it.
template <class Name>
Page build_named(const Soup& soup, const Leaf& leaf, BuildProgress* progress, Name&& name) {
    assert(!leaf.triangles.empty());
    const Box box{leaf.frame.to_local(leaf.box.lo), leaf.frame.to_local(leaf.box.hi)};
    std::vector<TrianglePair> pairs = pair_triangles(local_triangles(soup, leaf), progress);
    for (TrianglePair& pair : pairs) {
        pair.a = name(pair.a);
        pair.b = pair.b == kNone ? kNone : name(pair.b);
    }
    // Hits count inside the leaf's box only, so what reaches out of it need not be in the boxes.
    const Boxf inside{vec3(box.lo), vec3(box.hi)};
    std::vector<Boxf> boxes(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i) {
        for (const vec3& corner : pairs[i].corners)
            boxes[i].add(corner);
        boxes[i] = {glm::clamp(boxes[i].lo, inside.lo, inside.hi),
                    glm::clamp(boxes[i].hi, inside.lo, inside.hi)};
    }
    const std::vector<BvhNode> nodes = build_bvh(boxes, progress);
    const Grid grid(box);
    Page page = Packer(nodes, pairs, grid, progress).pack();
    assert(page.texels.size() / OVC_UNIT_TEXELS < OVC_MAX_UNITS);
    return page;
}

} // namespace

Page build_page(const Soup& soup, const Numbering& numbers, const Leaf& leaf,
                BuildProgress* progress) {
    return build_named(soup, leaf, progress,
                       [&](uint32_t i) { return numbers.of(leaf.triangles[i]); });
}

Page build_page(const Soup& soup, const Leaf& leaf, BuildProgress* progress) {
    return build_named(soup, leaf, progress, [](uint32_t i) { return i; });
}

uint32_t stack_depth(std::span<const Page> pages) {
    constexpr uint32_t kStep = 4;
    uint32_t depth = 1;
    for (const Page& page : pages)
        depth = std::max(depth, page.depth);
    return (depth + kStep - 1) / kStep * kStep;
}

} // namespace ovc
