// SPDX-License-Identifier: Apache-2.0
// Merging: two leaves side by side become one if they hold few enough triangles together.
#include "plugin/thesis/level1/merge_leaves.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <optional>

namespace ovc::thesis {
namespace {

/// The triangles of a leaf, sorted and without repetition.
using Members = std::vector<TriangleId>;

class Merger {
public:
    Merger(const KdTree& full, uint32_t max_triangles) : full_(full), max_(max_triangles) {}

    std::vector<KdNode> run() {
        if (!full_.nodes.empty())
            merge(0);
        return std::move(nodes_);
    }

private:
    /// Appends the merged subtree. Returns its triangles where it is one leaf that may still grow.
    std::optional<Members> merge(uint32_t node) {
        const KdNode& n = full_.nodes[node];
        const size_t at = nodes_.size();
        if (n.is_leaf()) {
            nodes_.push_back(KdNode::leaf(0, 0));
            const auto triangles = full_.triangles(n);
            return limited(Members(triangles.begin(), triangles.end()));
        }
        nodes_.push_back(KdNode::inner(n.axis(), n.split()));
        const std::optional<Members> below = merge(node + 1);
        nodes_[at].set_above(uint32_t(nodes_.size()));
        const std::optional<Members> above = merge(n.above());
        if (!below || !above)
            return std::nullopt;
        Members both;
        both.reserve(below->size() + above->size());
        std::set_union(below->begin(), below->end(), above->begin(), above->end(),
                       std::back_inserter(both));
        if (both.size() > max_)
            return std::nullopt;
        nodes_.erase(nodes_.begin() + ptrdiff_t(at), nodes_.end());
        nodes_.push_back(KdNode::leaf(0, 0));
        return both;
    }

    std::optional<Members> limited(Members members) const {
        std::sort(members.begin(), members.end());
        if (members.size() > max_)
            return std::nullopt;
        return members;
    }

    const KdTree& full_;
    const uint32_t max_;
    std::vector<KdNode> nodes_;
};

} // namespace

std::vector<KdNode> merge_leaves(const KdTree& full, uint32_t max_triangles) {
    assert(max_triangles > 0);
    return Merger(full, max_triangles).run();
}

} // namespace ovc::thesis
