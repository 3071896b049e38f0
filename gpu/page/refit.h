// SPDX-License-Identifier: Apache-2.0
// Refit: gives a page whose triangles have moved their new corners, and its boxes their new sizes.
// The tree keeps its shape, and so the page its bytes.
#pragma once

#include "core/numbering.h"
#include "core/soup.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// A set of triangles, by the numbers by which pages know them.
class NumberSet {
public:
    explicit NumberSet(uint64_t count) : words_((count + 63) / 64) {}

    void add(uint32_t number) { words_[number / 64] |= uint64_t(1) << (number % 64); }
    bool has(uint32_t number) const { return words_[number / 64] >> (number % 64) & 1; }

private:
    std::vector<uint64_t> words_;
};

/// The expected number of nodes that a ray opens in a page that it comes to, by the surface-area
/// heuristic.
struct RefitCost {
    double before;
    double after;
};

/// Refits a page of `leaf`, whose frame and grid hold its triangles. moved: the triangles whose
/// corners differ from those in the page; null, where all may, and where the leaf's frame or grid
/// is new. Boxes of a moved triangle hold all of it, also where the builder had cut it. parted:
/// receives the numbers of triangles that the page has lost, because the one that they shared a
/// side and a unit with shares it no more; some may come twice. Returns nothing, with the page
/// unusable, where it must be built anew: it has loose pairs, or lost too many triangles. Works on
/// all cores.
std::optional<RefitCost> refit_page(Page& page, const Soup& soup, const Numbering& numbers,
                                    const Leaf& leaf, const NumberSet* moved,
                                    std::vector<uint32_t>& parted);

/// Adds `added` to the numbers by which the page names its triangles.
void renumber(Page& page, uint32_t added);

} // namespace ovc
