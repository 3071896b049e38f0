// SPDX-License-Identifier: Apache-2.0
// The BVH of the thesis as texels: depth first, with skip pointers. Based on: thesis, section 3.1
// and chapter 4; Thrane and Simonsen 2005, section 4.4.
//
// texel 0      the root's texel, the first texel after the last triangle, 0, 0
// node         two texels: lower corner, w: the texel to go on at when the ray misses the box;
//              upper corner. Its children follow
// triangle     three texels, the highest bit of w of the first set: in place of a leaf's box
#pragma once

#include "plugin/thesis/system.h"

namespace ovc::thesis {

inline constexpr int kShuffles = 10; // thesis, chapter 4

/// Returns the best tree by insertion of kShuffles orders. Error: more texels than 31 bits count.
Result<System> build_skip_bvh(const Soup& soup, const Leaf& whole,
                              BuildProgress* progress = nullptr);

} // namespace ovc::thesis
