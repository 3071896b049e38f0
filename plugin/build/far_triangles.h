// SPDX-License-Identifier: Apache-2.0
// Which triangles of a scene rays meet before they set out: those that lie in leaves of their own
// and reach so far that no frame suits them and what is near them (docs/decisions/0038).
#pragma once

#include "core/lanes/far_triangle.h"

#include <cstdint>
#include <vector>

namespace ovc {

struct BuiltScene;

struct FarTriangles {
    std::vector<FarTriangle> triangles; // a few; their numbers are those of the scene
    std::vector<uint32_t> leaves;       // sorted; of level 1, which have these and no others

    bool empty() const { return triangles.empty(); }
};

/// Returns those of the scene's level 1, and none where nothing else would be left.
FarTriangles far_triangles_of(const BuiltScene& scene);

} // namespace ovc
