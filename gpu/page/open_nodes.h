// SPDX-License-Identifier: Apache-2.0
// Opens the largest nodes of pages that share a frame and a grid, until there are enough of them.
#pragma once

#include "gpu/page/page.h"
#include "shaders/layout.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A unit of a page, and its box in cells of the grid, each cell as large as it is in the frame.
struct Entry {
    uint32_t page;
    uint32_t unit;
    Boxf box;
};

std::span<const uvec4, OVC_UNIT_TEXELS> unit_of(const Page& page, uint32_t unit);
bool is_pair(const Page& page, uint32_t unit);
/// Returns the unit of the first child of a node.
uint32_t first_child(std::span<const Page> pages, const Entry& node);
Entry root_of(std::span<const Page> pages, uint32_t page);

/// Returns the roots of all pages, but replaces the largest nodes by their children, again and
/// again, as long as there are no more than `max` entries. If `max` is larger than the number of
/// pages, none of them lies on a disk. Based on: Benthin, Woop, Wald and Afra 2017, "Improved
/// Two-Level BVHs using Partial Re-Braiding".
std::vector<Entry> opened(std::span<const Page> pages, size_t max);

} // namespace ovc
