// SPDX-License-Identifier: Apache-2.0
// The unit sphere as triangles of about one size.
#pragma once

#include "testscenes/corners.h"

#include <cstdint>

namespace ovc {

/// 20 x 4^level triangles, the icosahedron's for level 0. Closed: neighbours share corners bit for
/// bit.
Corners make_sphere(uint32_t level);

} // namespace ovc
