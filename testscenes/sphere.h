// SPDX-License-Identifier: Apache-2.0
// The unit sphere as triangles of about the same size.
#pragma once

#include "testscenes/corners.h"

#include <cstdint>

namespace ovc {

/// Makes 20 x 4^level triangles, which are the icosahedron's for level 0. The sphere is closed:
/// neighbours share corners bit for bit.
Corners make_sphere(uint32_t level);

} // namespace ovc
