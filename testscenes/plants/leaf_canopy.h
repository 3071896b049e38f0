// SPDX-License-Identifier: Apache-2.0
// A canopy of leaves: quads that a picture cuts leaves out of, or the same leaves as triangles.
#pragma once

#include "core/scene.h"

namespace ovc {

struct LeafCanopy {
    enum class Leaves { CutOut, Modelled };

    uint32_t leaves = 100'000;
    Leaves as = Leaves::CutOut;
    uint32_t texels = 256; // the side of the picture
};

/// Makes the canopy. The triangles of leaf l begin with 2 l of mesh 0, or with 22 l if the leaves
/// are modelled.
Scene make_leaf_canopy(const LeafCanopy& canopy);

} // namespace ovc
