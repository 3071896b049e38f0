// SPDX-License-Identifier: Apache-2.0
// Checks whether texels from outside, such as a file, are a page that may be walked.
#pragma once

#include "gpu/page/page.h"

#include <cstdint>

namespace ovc {

/// Returns true if every walk of the page ends, stays within the page and within `page.depth` words
/// of stack, and names only triangles below triangle_count. It does not check that boxes hold their
/// triangles.
bool is_walkable(const Page& page, uint32_t triangle_count);

} // namespace ovc
