// SPDX-License-Identifier: Apache-2.0
// Works in rounds: it searches for moves in parallel, in a tree that stands still, and makes them
// one by one.
#include "gpu/bvh/reinsert.h"

#include "core/system/parallel.h"
#include "gpu/bvh/best_move.h"

#include <algorithm>

namespace ovc {
namespace {

constexpr double kTried = 0.05; // the share of subtrees tried in a round: the most promising
constexpr int kMaxRounds = 16;
constexpr size_t kSearchGrain = 256; // searches a task

/// hope: the saving of the tree without the subtree. It does not count how nodes above then shrink.
struct Trial {
    float hope;
    uint32_t place;
};

std::vector<Trial> trials(const SiblingTree& tree, size_t min_tried) {
    std::vector<Trial> all;
    all.reserve(tree.end());
    for (uint32_t place = SiblingTree::kFirst; place < tree.end(); ++place)
        all.push_back(
            {tree.half_area(tree.parent(place)) - tree.half_area(SiblingTree::sibling(place)),
             place});
    const size_t tried = std::max(size_t(kTried * double(all.size())) + 1, min_tried);
    if (tried < all.size()) {
        std::nth_element(all.begin(), all.begin() + ptrdiff_t(tried), all.end(),
                         [](const Trial& a, const Trial& b) {
                             return a.hope > b.hope || (a.hope == b.hope && a.place < b.place);
                         });
        all.resize(tried);
    }
    return all;
}

/// Returns the moves that gain, the largest gain first.
std::vector<Move> moves(const SiblingTree& tree, size_t min_tried, BuildProgress* progress) {
    const std::vector<Trial> tried = trials(tree, min_tried);
    std::vector<Move> moves(tried.size());
    parallel_for(tried.size(), kSearchGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            moves[i] = MoveSearch(tree, tried[i].place).best();
        add(progress, 0);
    });
    std::erase_if(moves, [](const Move& move) -> bool { return move.to == kNone; });
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
        return a.gain > b.gain || (a.gain == b.gain && a.from < b.from);
    });
    return moves;
}

/// Makes the moves that still gain after the ones before them. Returns their total gain.
double make(const std::vector<Move>& moves, uint32_t max_height, SiblingTree& tree) {
    double gain = 0;
    for (const auto& [from, to, hoped] : moves) {
        if (!tree.can_move(from, to))
            continue;
        const uint32_t parent = tree.parent(from);
        const float change = tree.move(from, to);
        if (change < 0 && tree.height(0) <= max_height)
            gain -= double(change);
        else
            tree.move(from, parent);
    }
    return gain;
}

} // namespace

void reinsert(std::vector<BvhNode>& nodes, BuildProgress* progress, const ReinsertEffort& effort) {
    if (nodes.empty())
        return;
    SiblingTree tree(nodes);
    const uint32_t max_height = tree.height(0);
    double cost = tree.cost();
    for (int round = 0; round < kMaxRounds; ++round) {
        const double gain = make(moves(tree, effort.min_tried, progress), max_height, tree);
        cost -= gain;
        if (gain <= effort.worthwhile * cost)
            break;
    }
    nodes = tree.nodes();
}

} // namespace ovc
