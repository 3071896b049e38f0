// SPDX-License-Identifier: Apache-2.0
// Packs the tree by insertion depth first.
#include "plugin/thesis/skip_bvh.h"

#include "plugin/thesis/level1/goldsmith_salmon.h"

#include <cassert>

namespace ovc::thesis {
namespace {

constexpr uint32_t kTriangle = 0x80000000u;
constexpr uint32_t kRoot = 1;

class Packer {
public:
    Packer(const InsertionTree& tree, const std::vector<LocalTriangle>& triangles)
        : tree_(tree), triangles_(triangles) {}

    Texels pack() {
        assert(!tree_.nodes.empty());
        texels_ = {uvec4(0)};
        std::vector<Open> open; // inner nodes above, whose skip pointers are set at their end
        for (uint32_t n = 0; n != kNone || !open.empty();) {
            if (n == kNone) {
                texels_[open.back().texel].w = uint32_t(texels_.size());
                n = tree_.nodes[open.back().node].next_sibling;
                open.pop_back();
                continue;
            }
            const InsertionNode& node = tree_.nodes[n];
            if (node.item != kNone) {
                append(texels_, triangles_[node.item], node.item, kTriangle);
                n = node.next_sibling;
                continue;
            }
            open.push_back({n, texels_.size()});
            texels_.push_back(texel(node.box.lo - vec3(float(kWider))));
            texels_.push_back(texel(node.box.hi + vec3(float(kWider))));
            n = node.first_child;
        }
        texels_[0] = {kRoot, uint32_t(texels_.size()), 0, 0};
        texels_.push_back(uvec4(0)); // the kernel fetches three texels wherever it stands
        return std::move(texels_);
    }

private:
    struct Open {
        uint32_t node;
        size_t texel;
    };

    const InsertionTree& tree_;
    const std::vector<LocalTriangle>& triangles_;
    Texels texels_;
};

} // namespace

Result<System> build_skip_bvh(const Soup& soup, const Leaf& whole, BuildProgress* progress) {
    const std::vector<LocalTriangle> triangles = local_triangles(soup, whole);
    std::vector<Boxf> boxes(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i)
        for (const vec3& corner : triangles[i])
            boxes[i].add(corner);
    const InsertionTree tree = best_insertion_tree(boxes, kShuffles, progress);
    if (3 * triangles.size() + 2 * tree.nodes.size() >= kTriangle)
        return over_budget("the BVH has more texels than 31 bits count");
    return System{Packer(tree, triangles).pack(), triangles.size()};
}

} // namespace ovc::thesis
