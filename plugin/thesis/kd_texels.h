// SPDX-License-Identifier: Apache-2.0
// The KD-tree of the CPU KDT as texels for kd-restart. Based on: Foley and Sugerman 2005; Thrane
// and Simonsen 2005, section 4.3.
//
// texel 0      where nodes, references and triangles begin (texels)
// nodes        two a texel. Inner: split (float bits), axis | node above << 2; the node below is
//              the next. Leaf: first reference, 3 | references << 2
// references   four a texel: triangles
// triangles    three texels each
#pragma once

#include "plugin/thesis/system.h"

namespace ovc::thesis {

/// Returns the tree, which lists every triangle in each leaf that it touches when the leaf's cell,
/// between planes rounded to float, is wider by kWider. Error: more nodes or references than 30
/// bits count.
Result<System> build_kd_texels(const Soup& soup, const Leaf& whole,
                               BuildProgress* progress = nullptr);

} // namespace ovc::thesis
