// SPDX-License-Identifier: Apache-2.0
// The KD-tree: takes planes into the frame, and puts triangles into leaves anew, because the
// kernel's planes are not where the builder's were.
#include "plugin/thesis/kd_texels.h"

#include "kdtree/build.h"
#include "kdtree/clip.h"
#include "plugin/thesis/references.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {
namespace {

/// The tree's nodes with planes in the frame.
class LocalTree {
public:
    LocalTree(const KdTree& tree, const Leaf& whole)
        : nodes_(tree.nodes),
          planes_(tree.nodes.size()),
          bounds_{whole.frame.to_local(whole.box.lo), whole.frame.to_local(whole.box.hi)} {
        for (size_t n = 0; n < nodes_.size(); ++n)
            if (!nodes_[n].is_leaf()) {
                dvec3 at(whole.frame.origin);
                at[nodes_[n].axis()] = nodes_[n].split();
                planes_[n] = float(whole.frame.to_local(at)[nodes_[n].axis()]);
            }
    }

    size_t size() const { return nodes_.size(); }

    /// Appends a reference for each leaf node that the triangle touches.
    void find_leaves(const LocalTriangle& local, uint32_t id, std::vector<Reference>& out) const {
        const Triangle triangle = {dvec3(local[0]), dvec3(local[1]), dvec3(local[2])};
        hand_down(triangle, bounds_of(triangle), id, 0, bounds_, out);
    }

    /// Appends the two words of a node; a leaf's come from its references.
    void append_node(size_t n, const References& references, std::vector<uint32_t>& words) const {
        const KdNode& node = nodes_[n];
        const uint32_t first = references.first[n];
        words.push_back(node.is_leaf() ? first : bits(planes_[n]));
        words.push_back(node.is_leaf() ? 3 | (references.first[n + 1] - first) << 2
                                       : uint32_t(node.axis()) | node.above() << 2);
    }

private:
    void hand_down(const Triangle& triangle, const Box& box, uint32_t id, uint32_t n,
                   const Box& cell, std::vector<Reference>& out) const {
        const KdNode& node = nodes_[n];
        if (node.is_leaf()) {
            const Box wider = cell.padded(kWider);
            const bool inside = wider.contains(box.lo) && wider.contains(box.hi);
            if (inside || !clipped_bounds(triangle, wider).empty())
                out.push_back({n, id});
            return;
        }
        const int axis = node.axis();
        const double plane = planes_[n];
        if (box.lo[axis] <= plane + kWider) {
            Box below = cell;
            below.hi[axis] = plane;
            hand_down(triangle, box, id, n + 1, below, out);
        }
        if (box.hi[axis] >= plane - kWider) {
            Box above = cell;
            above.lo[axis] = plane;
            hand_down(triangle, box, id, node.above(), above, out);
        }
    }

    const std::vector<KdNode>& nodes_;
    std::vector<float> planes_;
    Box bounds_;
};

constexpr size_t kMaxCounted = size_t(1) << 30;

} // namespace

Result<System> build_kd_texels(const Soup& soup, const Leaf& whole, BuildProgress* progress) {
    KdBuildOptions options;
    options.progress = progress;
    const KdTree tree = build_kd_tree(soup, whole.triangles, whole.box, options);
    const std::vector<LocalTriangle> triangles = local_triangles(soup, whole);
    const LocalTree local(tree, whole);
    const References references = gather_references(
        triangles.size(), local.size(), progress,
        [&](uint32_t i, std::vector<Reference>& out) { local.find_leaves(triangles[i], i, out); });
    if (local.size() >= kMaxCounted || references.triangles.size() >= kMaxCounted)
        return over_budget("the KD-tree has more nodes or references than 30 bits count");

    assert(references.first.size() == local.size() + 1);
    System system;
    Texels& texels = system.texels;
    texels = {uvec4(0)};
    std::vector<uint32_t> words;
    for (size_t n = 0; n < local.size(); ++n)
        local.append_node(n, references, words);
    append(texels, words);
    const uint32_t lists = uint32_t(texels.size());
    append(texels, references.triangles);
    texels[0] = {1, lists, uint32_t(texels.size()), 0};
    for (uint32_t i = 0; i < triangles.size(); ++i)
        append(texels, triangles[i], i);
    system.references = references.triangles.size();
    return system;
}

} // namespace ovc::thesis
