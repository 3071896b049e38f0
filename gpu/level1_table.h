// SPDX-License-Identifier: Apache-2.0
// Level 1 as texels, in the layout of shaders/layout.h: what the kernel walks.
#pragma once

#include "core/vec.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// All leaves outside the pool. level1 has nodes.
std::vector<uvec4> pack_level1(const Level1& level1);

/// Texels that pack_level1() makes of so many leaves and nodes.
inline uint64_t level1_texels(uint64_t leaves, uint64_t nodes) {
    return OVC_LEVEL1_LEAVES + OVC_LEAF_TEXELS * leaves + nodes;
}
inline uint64_t level1_texels(const Level1& level1) {
    return level1_texels(level1.leaves.size(), level1.nodes.size());
}

/// The texel that says where a leaf's page is.
inline uint64_t page_texel_of(uint32_t leaf) {
    return OVC_LEVEL1_LEAVES + uint64_t(OVC_LEAF_TEXELS) * leaf + OVC_LEAF_PAGE_TEXEL;
}

} // namespace ovc
