// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/rules.h"

namespace ovc::csg {

Rules::Rules(const Tree& tree)
    : tree_(tree),
      parent_(tree.nodes.size()),
      node_of_(tree.operands.size()),
      shown_(tree.operands.size(), 1),
      is_cut_(tree.operands.size()) {
    for (uint32_t n = 0; n < tree.nodes.size(); ++n) {
        parent_[n] = n;
        for (const uint32_t child : tree.nodes[n].children)
            parent_[child] = n;
        if (tree.nodes[n].kind == Kind::Operand)
            node_of_[tree.nodes[n].operand] = n;
    }
    for (uint32_t i = 0; i < tree.operands.size(); ++i)
        for (uint32_t at = node_of_[i]; at + 1 < tree.nodes.size(); at = parent_[at]) {
            const Node& node = tree.nodes[parent_[at]];
            if (node.kind == Kind::Clip && at != node.children[0])
                shown_[i] = 0;
            is_cut_[i] = is_cut_[i] || (node.kind != Kind::Union && node.children.size() > 1);
        }
}

std::vector<uint32_t> Rules::cutters(uint32_t operand) const {
    std::vector<uint32_t> all;
    for (uint32_t at = node_of_[operand]; at + 1 < tree_.nodes.size(); at = parent_[at]) {
        const Node& node = tree_.nodes[parent_[at]];
        for (const uint32_t child : node.children)
            if (node.kind != Kind::Union && child != at)
                gather(child, all);
    }
    return all;
}

void Rules::gather(uint32_t node, std::vector<uint32_t>& operands) const {
    if (tree_.nodes[node].kind == Kind::Operand)
        operands.push_back(tree_.nodes[node].operand);
    for (const uint32_t child : tree_.nodes[node].children)
        gather(child, operands);
}

Sides Rules::inside(uint32_t number, const std::function<Sides(uint32_t)>& sides) const {
    const Node& node = tree_.nodes[number];
    if (node.kind == Kind::Operand)
        return sides(node.operand);
    const bool all = node.kind == Kind::Intersection || node.kind == Kind::Clip;
    Sides sum{all, all};
    for (const uint32_t child : node.children) {
        const Sides one = inside(child, sides);
        sum.above = all ? sum.above && one.above : sum.above || one.above;
        sum.below = all ? sum.below && one.below : sum.below || one.below;
        if (sum.above != all && sum.below != all)
            break;
    }
    return sum;
}

bool Rules::stays(uint32_t operand, bool below_is_inside,
                  const std::function<Sides(uint32_t)>& sides) const {
    for (uint32_t at = node_of_[operand]; at + 1 < tree_.nodes.size(); at = parent_[at]) {
        const Node& node = tree_.nodes[parent_[at]];
        if (node.kind == Kind::Union)
            continue;
        bool before = false; // The sibling comes before.
        for (size_t i = node.children.size(); i-- > 0;) {
            if (node.children[i] == at) {
                before = true;
                continue;
            }
            const Sides other = inside(node.children[i], sides);
            if (other.above == other.below) {
                if (other.above == (node.kind == Kind::Merge))
                    return false;
                continue;
            }
            // The sibling has a surface here as well. If both solids lie on one side, the first
            // surface is enough. If they lie back to back, neither stays.
            const bool one_side = other.below == below_is_inside;
            if (!one_side || (before && node.kind != Kind::Clip))
                return false;
        }
    }
    return true;
}

} // namespace ovc::csg
