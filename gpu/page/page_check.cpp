// SPDX-License-Identifier: Apache-2.0
// Visits every unit that a walk can reach, once, as a walk that meets every box would.
#include "gpu/page/page_check.h"

#include "gpu/bvh/bvh.h"
#include "gpu/page/node_boxes.h"

#include <cmath>

namespace ovc {
namespace {

/// Returns whether the grid is plausible in a leaf's frame, where the leaf is about as large as 1.
bool has_sound_grid(std::span<const uvec4> head) {
    constexpr float kFarthest = 16;
    const GridHeader grid = header_of(head);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(grid.middle[axis]) <= kFarthest) || !(grid.cell[axis] > 0) ||
            !(grid.cell[axis] <= kFarthest / kGridLast))
            return false;
    return true;
}

bool is_missing(std::span<const uvec4> node, uint32_t child) {
    for (uint32_t axis = 0; axis < 3; ++axis)
        if (range_of(node[axis], child) != GridRange())
            return false;
    return true;
}

bool has_box(std::span<const uvec4> node, uint32_t child) {
    for (uint32_t axis = 0; axis < 3; ++axis)
        if (range_of(node[axis], child).empty())
            return false;
    return true;
}

class PageChecker {
public:
    PageChecker(const Page& page, uint32_t triangle_count, uint32_t first_number)
        : page_(page),
          texels_(page.view()),
          triangle_count_(triangle_count),
          first_number_(first_number) {}

    bool check() {
        const uint64_t units = page_.units();
        if (texels_.size() % OVC_UNIT_TEXELS || units <= OVC_ROOT_UNIT ||
            page_.depth > uint32_t(kMaxBvhDepth) ||
            !is_sound_head(texels_.first(kHeadTexels), units))
            return false;
        seen_.assign(units, 0);
        if (!reach(OVC_ROOT_UNIT, 1))
            return false;
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            if (!check_unit(next))
                return false;
        }
        return true;
    }

private:
    struct Pending {
        uint32_t unit;
        uint32_t depth;
    };

    std::span<const uvec4> unit(uint32_t number) const {
        return texels_.subspan(size_t(number) * OVC_UNIT_TEXELS, OVC_UNIT_TEXELS);
    }
    const uvec4& texel(uint32_t number, uint32_t i) const { return unit(number)[i]; }

    /// Marks a unit for a visit. Returns false if a walk would leave the page, or come to the same
    /// unit on two ways.
    bool reach(uint64_t unit, uint32_t depth) {
        if (unit >= seen_.size() || seen_[unit])
            return false;
        seen_[unit] = 1;
        pending_.push_back({uint32_t(unit), depth});
        return true;
    }

    bool check_unit(const Pending& at) {
        if ((texel(at.unit, 3).w & OVC_PAIR) && at.unit != OVC_ROOT_UNIT) {
            if ((texel(at.unit, 3).w & OVC_LOOSE_PAIR) && !page_.has_loose_pairs())
                return false;
            const uint32_t b = texel(at.unit, 1).w;
            return is_there(texel(at.unit, 0).w) && (is_there(b) || b == OVC_NO_TRIANGLE);
        }
        const uvec4& last = texel(at.unit, 3);
        if (last.y != 0 || last.z != 0 || last.w != 0 || at.depth > page_.depth)
            return false;
        const uint64_t base = last.x;
        for (uint32_t child = 0; child < 4; ++child)
            if (!is_missing(unit(at.unit), child) &&
                (!has_box(unit(at.unit), child) || !reach(base + child, at.depth + 1)))
                return false;
        return true;
    }

    /// Whether a triangle has the number; those below the first wrap around.
    bool is_there(uint32_t number) const { return number - first_number_ < triangle_count_; }

    const Page& page_;
    const std::span<const uvec4> texels_;
    const uint32_t triangle_count_;
    const uint32_t first_number_;
    std::vector<uint8_t> seen_; // per unit
    std::vector<Pending> pending_;
};

} // namespace

bool is_sound_head(std::span<const uvec4> head, uint64_t units) {
    const auto root = head.subspan(OVC_ROOT_UNIT * OVC_UNIT_TEXELS);
    if (units <= OVC_ROOT_UNIT || units >= OVC_MAX_PAGE_UNITS ||
        head[2] != uvec4(OVC_ROOT_UNIT, 0xffffffffu, 0, 0) || !has_sound_grid(head) ||
        is_missing(root, 0) || root[3].y || root[3].z || root[3].w)
        return false;
    for (uint32_t child = 0; child < 4; ++child)
        if (!is_missing(root, child) &&
            (!has_box(root, child) || uint64_t(root[3].x) + child >= units))
            return false;
    return true;
}

bool is_walkable(const Page& page, uint32_t triangle_count, uint32_t first_number) {
    return PageChecker(page, triangle_count, first_number).check();
}

} // namespace ovc
