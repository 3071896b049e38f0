// SPDX-License-Identifier: Apache-2.0
// Whether texels that somebody else wrote are a page that may be walked.
#pragma once

#include "gpu/page/page.h"

#include <cstdint>

namespace ovc {

/// True where every walk of the page ends, stays within it and within `page.depth` words of stack,
/// and names triangles below triangle_count. Whether its boxes hold its triangles it does not tell.
bool is_walkable(const Page& page, uint32_t triangle_count);

} // namespace ovc
