// SPDX-License-Identifier: Apache-2.0
// Level 1: doubles into words.
#include "gpu/level1_table.h"

#include <bit>

namespace ovc {
namespace {

uvec4 words(double a, double b) {
    const auto x = std::bit_cast<uint64_t>(a);
    const auto y = std::bit_cast<uint64_t>(b);
    return {uint32_t(x), uint32_t(x >> 32), uint32_t(y), uint32_t(y >> 32)};
}

void put_box(std::vector<uvec4>& texels, const Box& box) {
    texels.push_back(words(box.lo.x, box.lo.y));
    texels.push_back(words(box.lo.z, box.hi.x));
    texels.push_back(words(box.hi.y, box.hi.z));
}

void put_leaf(std::vector<uvec4>& texels, const Leaf& leaf) {
    put_box(texels, leaf.box);
    texels.push_back(words(leaf.frame.origin.x, leaf.frame.origin.y));
    texels.push_back(words(leaf.frame.origin.z, leaf.frame.scale));
    texels.push_back({OVC_NOT_RESIDENT, 0, 0, 0});
}

} // namespace

std::vector<uvec4> pack_level1(const Level1& level1) {
    std::vector<uvec4> texels;
    texels.reserve(level1_texels(level1));
    const uint32_t root =
        OVC_LEVEL1_LEAVES + uint32_t(OVC_LEAF_TEXELS) * uint32_t(level1.leaves.size());
    texels.push_back({root, 0, 0, 0});
    for (const Leaf& leaf : level1.leaves)
        put_leaf(texels, leaf);
    for (const KdNode& node : level1.nodes) {
        uvec4 texel = words(node.is_leaf() ? 0 : node.split(), 0);
        texel.z = node.is_leaf() ? 3 | node.count() << 2 : uint32_t(node.axis());
        texel.w = node.is_leaf() ? node.first() : root + node.above();
        texels.push_back(texel);
    }
    return texels;
}

} // namespace ovc
