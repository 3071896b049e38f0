// SPDX-License-Identifier: Apache-2.0
// Joins leaves of a BVH, and packs 18 coordinates of 24 bits into 13 words and a half.
#include "gpu/bvh/loose_pairs.h"

#include "core/ray.h"

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

// The max ratio of the joint box to both boxes together. Measured on soup-500: up to this, pages
// shrink and a ray takes no more steps, because one node above the two triangles is saved.
constexpr float kMaxGrowth = 2;
// The max absolute value of a coordinate whose rounding fits into 24 bits.
constexpr float kReach = 1 - 0x1p-20f;

bool can_be_loose(const TrianglePair& pair) {
    if (pair.b != kNone)
        return false;
    return std::ranges::all_of(pair.corners, [](const vec3& c) {
        return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) <= kReach;
    });
}

double steps(float x) {
    return std::round(double(x) / OVC_LOOSE_STEP);
}

/// Returns the coordinate in steps, signed, in the upper 24 bits of a word.
uint32_t counted(float x) {
    return uint32_t(int32_t(steps(x))) << 8;
}

/// Puts byte i of a counted coordinate, the lowest being 0, below the coordinate in `word`.
void put_byte(uint32_t& word, uint32_t of, int i) {
    word |= of >> (8 + 8 * i) & 0xff;
}

/// Joins leaves two by two, from the deepest nodes up.
class Joiner {
public:
    Joiner(std::vector<BvhNode>& nodes, std::span<const TrianglePair> pairs)
        : nodes_(nodes), pairs_(pairs) {}

    std::vector<LoosePair> join() {
        for (size_t i = nodes_.size(); i-- > 0;) // a node's subtree comes behind it
            if (!nodes_[i].is_leaf())
                join_below(uint32_t(i));
        return std::move(loose_);
    }

private:
    void join_below(uint32_t node) {
        const uint32_t left = node + 1, right = nodes_[node].right;
        if (is_alone(left) && is_alone(right)) {
            if (worth_joining(left, right))
                nodes_[node] = joined(left, right);
        } else if (is_alone(left)) {
            join_across(node, left, right);
        } else if (is_alone(right)) {
            join_across(node, right, left);
        }
    }

    /// Joins a child of the node that is a leaf with a leaf below the other child. The rest of that
    /// child then takes its place.
    void join_across(uint32_t node, uint32_t alone, uint32_t sibling) {
        if (nodes_[sibling].is_leaf())
            return;
        const uint32_t first = sibling + 1, second = nodes_[sibling].right;
        const uint32_t partner = is_alone(first) ? first : second;
        if (!is_alone(partner) || !worth_joining(alone, partner))
            return;
        const BvhNode pair = joined(alone, partner);
        nodes_[node].right = partner == first ? second : first;
        nodes_[node + 1] = pair;
    }

    bool is_alone(uint32_t node) const {
        const BvhNode& n = nodes_[node];
        return n.is_leaf() && n.item < pairs_.size() && can_be_loose(pairs_[n.item]);
    }

    Boxf box_of(uint32_t a, uint32_t b) const {
        Boxf both = nodes_[a].box;
        both.add(nodes_[b].box);
        return both;
    }

    bool worth_joining(uint32_t a, uint32_t b) const {
        const float apart = nodes_[a].box.half_area() + nodes_[b].box.half_area();
        return box_of(a, b).half_area() <= kMaxGrowth * apart;
    }

    BvhNode joined(uint32_t a, uint32_t b) {
        loose_.push_back({nodes_[a].item, nodes_[b].item});
        return {box_of(a, b), 0, uint32_t(pairs_.size() + loose_.size() - 1)};
    }

    std::vector<BvhNode>& nodes_;
    const std::span<const TrianglePair> pairs_;
    std::vector<LoosePair> loose_;
};

} // namespace

bool worth_loosening(size_t pairs, size_t triangles) {
    return 4 * pairs > 3 * triangles;
}

std::vector<LoosePair> join_loose(std::vector<BvhNode>& nodes,
                                  std::span<const TrianglePair> pairs) {
    return Joiner(nodes, pairs).join();
}

vec3 in_steps(const vec3& corner) {
    vec3 rounded;
    for (int axis = 0; axis < 3; ++axis)
        rounded[axis] = float(steps(corner[axis]) * OVC_LOOSE_STEP);
    return rounded;
}

void put_loose(const TrianglePair& first, const TrianglePair& second,
               std::span<uvec4, OVC_UNIT_TEXELS> unit) {
    std::array<std::array<uint32_t, 3>, 6> corners;
    for (size_t i = 0; i < 6; ++i)
        for (int axis = 0; axis < 3; ++axis)
            corners[i][size_t(axis)] =
                counted((i < 3 ? first.corners[i] : second.corners[i - 3])[axis]);
    for (size_t i = 0; i < 4; ++i)
        unit[i] = {corners[i][0], corners[i][1], corners[i][2], 0};
    // The coordinates of corner 4, and the first of corner 5, lie in the low bytes of a texel each.
    const std::array<uint32_t, 4> below{corners[4][0], corners[4][1], corners[4][2], corners[5][0]};
    for (size_t i = 0; i < 4; ++i)
        for (int byte = 0; byte < 3; ++byte)
            put_byte(unit[i][byte], below[i], byte);
    unit[0].w = first.a;
    unit[1].w = second.a;
    unit[2].w = corners[5][1];
    put_byte(unit[2].w, corners[5][2], 2);
    unit[3].w = OVC_PAIR | OVC_LOOSE_PAIR | (corners[5][2] >> 8 & 0xffff);
}

} // namespace ovc
