// SPDX-License-Identifier: Apache-2.0
// Checks whether texels from outside, such as a file, are a page that may be walked.
#pragma once

#include "gpu/page/page.h"

#include <cstdint>
#include <span>

namespace ovc {

/// Returns true if every walk of the page ends, stays within the page and within `page.depth` words
/// of stack, and names only triangles of triangle_count from first_number on. It does not check
/// that boxes hold their triangles.
bool is_walkable(const Page& page, uint32_t triangle_count, uint32_t first_number = 0);

/// Returns whether this is the head of such a page of so many units, as far as the head tells: a
/// tree over pages may be built by it.
bool is_sound_head(std::span<const uvec4> head, uint64_t units);

} // namespace ovc
