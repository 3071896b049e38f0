// SPDX-License-Identifier: Apache-2.0
// A canopy of leaves: quads that a picture cuts leaves out of, or the same leaves as triangles.
#pragma once

#include "core/scene.h"

namespace ovc {

struct LeafCanopy {
    enum class Leaves { CutOut, Modelled };

    uint32_t leaves = 100'000;
    Leaves as = Leaves::CutOut;
    uint32_t texels = 256; // a side of the picture
};

/// Leaf l is the triangles from 2 l on of mesh 0, or from 22 l on where the leaves are modelled.
Scene make_leaf_canopy(const LeafCanopy& canopy);

} // namespace ovc
