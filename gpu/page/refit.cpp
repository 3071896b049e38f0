// SPDX-License-Identifier: Apache-2.0
// Refits a page from its pairs up. Boxes are joined as ranges of the page's grid, so that a box
// above others is the one that the packer would have written.
#include "gpu/page/refit.h"

#include "core/system/parallel.h"
#include "gpu/page/grid.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/packer.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <mutex>
#include <utility>

namespace ovc {
namespace {

using Ranges = std::array<GridRange, 3>;

/// The result of fitting a subtree.
struct Fitted {
    bool changed = false;
    Ranges box;        // of the subtree
    double before = 0; // the areas of all boxes of its nodes
    double after = 0;
};

class Refitter {
public:
    Refitter(Page& page, const Soup& soup, const Numbering& numbers, const Leaf& leaf,
             const NumberSet* moved, std::vector<uint32_t>& parted)
        : texels_(page.texels),
          soup_(soup),
          numbers_(numbers),
          leaf_(leaf),
          grid_({leaf.frame.to_local(leaf.grid.lo), leaf.frame.to_local(leaf.grid.hi)}),
          moved_(moved),
          parted_(parted),
          max_parted_(page.units() / 32 + 16),
          cell_before_(header_of(texels_).cell),
          is_large_(page.units() >= kParallelUnits) {}

    std::optional<RefitCost> refit() {
        const GridHeader header = grid_.header();
        for (int axis = 0; axis < 3; ++axis) {
            texels_[0][axis] = bits(header.middle[axis]);
            texels_[1][axis] = bits(header.cell[axis]);
        }
        const Ranges root = box_of(OVC_ROOT_UNIT);
        const Fitted fitted = fit(OVC_ROOT_UNIT, 0);
        if (!is_sound_ || parted_.size() > max_parted_)
            return std::nullopt;
        return RefitCost{fitted.before / half_area(root, cell_before_),
                         fitted.after / half_area(fitted.box, header.cell)};
    }

private:
    static constexpr uint64_t kParallelUnits = 8192;
    static constexpr int kForkDepth = 4; // 256 subtrees

    std::span<uvec4, OVC_UNIT_TEXELS> unit(uint32_t index) const {
        return texels_.subspan(size_t(index) * OVC_UNIT_TEXELS).first<OVC_UNIT_TEXELS>();
    }

    static bool is_there(std::span<const uvec4, OVC_UNIT_TEXELS> node, size_t child) {
        return !range_of(node[0], child).empty();
    }

    static double half_area(const Ranges& box, const vec3& cell) {
        std::array<double, 3> size{};
        for (size_t axis = 0; axis < 3; ++axis)
            size[axis] = (double(box[axis].hi) - double(box[axis].lo)) * double(cell[int(axis)]);
        return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
    }

    /// Returns the box of a node, around those of its children.
    Ranges box_of(uint32_t node) const {
        const auto words = unit(node);
        Ranges box;
        for (size_t axis = 0; axis < 3; ++axis)
            for (size_t child = 0; child < 4; ++child) {
                const GridRange range = range_of(words[axis], child);
                box[axis].lo = std::min(box[axis].lo, range.lo);
                box[axis].hi = std::max(box[axis].hi, range.hi);
            }
        return box;
    }

    Fitted fit(uint32_t at, int depth) {
        const auto words = unit(at);
        if (words[3].w & OVC_PAIR)
            return fit_pair(words);
        Fitted all;
        all.before = half_area(box_of(at), cell_before_);
        fetch_corners(words[3].x);
        std::array<Fitted, 4> children;
        const auto fit_child = [&](size_t child) {
            if (is_there(words, child))
                children[child] = fit(words[3].x + uint32_t(child), depth + 1);
        };
        if (is_large_ && depth < kForkDepth)
            parallel_for(4, 1, [&](size_t first, size_t last) {
                for (size_t child = first; child < last; ++child)
                    fit_child(child);
            });
        else
            for (size_t child = 0; child < 4; ++child)
                fit_child(child);
        for (size_t child = 0; child < 4; ++child) {
            const Fitted& fitted = children[child];
            if (fitted.changed)
                for (size_t axis = 0; axis < 3; ++axis)
                    put_range(words[axis], child, fitted.box[axis]);
            all.changed |= fitted.changed;
            all.before += fitted.before;
            all.after += fitted.after;
        }
        all.box = box_of(at);
        all.after += half_area(all.box, grid_.header().cell);
        return all;
    }

    bool has_moved(uint32_t number) const {
        return number != OVC_NO_TRIANGLE && (!moved_ || moved_->has(number));
    }

    /// Asks for the corners of the pairs among the four units from `first` on, of which the last
    /// may be others' or none: the corners lie anywhere in memory, and waiting for one after the
    /// other takes twice the time.
    void fetch_corners(uint32_t first) const {
        const size_t end = std::min(size_t(first) + 4, texels_.size() / OVC_UNIT_TEXELS);
        for (size_t at = first; at < end; ++at) {
            const auto words = unit(uint32_t(at));
            if (words[3].w & OVC_PAIR)
                for (const uint32_t number : {words[0].w, words[1].w})
                    if (has_moved(number)) {
                        const TriangleId id = numbers_.id(number);
                        __builtin_prefetch(soup_.chunks[id.mesh].address_of(id.prim));
                    }
        }
    }

    std::array<vec3, 3> local_corners(uint32_t number) const {
        const Triangle world = soup_.triangle(numbers_.id(number));
        std::array<vec3, 3> local;
        for (size_t i = 0; i < 3; ++i)
            local[i] = vec3(leaf_.frame.to_local(world[i]));
        return local;
    }

    static bool name_two(uint32_t first, uint32_t last) {
        return first != last && first < 3 && last < 3;
    }
    /// Notes that a triangle leaves the page.
    void part(uint32_t number) {
        const std::lock_guard lock(mutex_);
        parted_.push_back(number);
    }

    Fitted fit_pair(std::span<uvec4, OVC_UNIT_TEXELS> words) {
        const uint32_t a = words[0].w, b = words[1].w, order = words[2].w;
        if (!has_moved(a) && !has_moved(b))
            return {};
        // The corners of the unit: v0 and v2 are those that both triangles have.
        std::array<vec3, 4> corners;
        const std::array<vec3, 3> of_a = local_corners(a);
        const uint32_t first = order & 3, last = order >> 2 & 3;
        const uint32_t first_of_b = order >> 4 & 3, last_of_b = order >> 6 & 3;
        bool is_pair = b != OVC_NO_TRIANGLE;
        if (!name_two(first, last) || (is_pair && !name_two(first_of_b, last_of_b))) {
            is_sound_ = false; // the page is from a damaged file
            return {};
        }
        corners[0] = of_a[first];
        corners[2] = of_a[last];
        corners[1] = corners[3] = of_a[3 - first - last];
        if (is_pair) {
            const std::array<vec3, 3> of_b = local_corners(b);
            is_pair = of_b[first_of_b] == corners[0] && of_b[last_of_b] == corners[2];
            if (is_pair) {
                corners[3] = of_b[3 - first_of_b - last_of_b];
            } else { // a stays alone
                part(b);
                words[1].w = OVC_NO_TRIANGLE;
                words[2].w = order & 15;
            }
        }
        Boxf box;
        for (size_t i = 0; i < 4; ++i) {
            words[i] = {bits(corners[i].x), bits(corners[i].y), bits(corners[i].z), words[i].w};
            box.add(corners[i]);
        }
        Fitted fitted{.changed = true};
        for (int axis = 0; axis < 3; ++axis)
            fitted.box[size_t(axis)] = grid_.range(box, axis);
        return fitted;
    }

    const std::span<uvec4> texels_;
    const Soup& soup_;
    const Numbering& numbers_;
    const Leaf& leaf_;
    const Grid grid_;
    const NumberSet* const moved_;
    std::vector<uint32_t>& parted_;
    const size_t max_parted_;
    const vec3 cell_before_;
    const bool is_large_;
    std::atomic<bool> is_sound_{true};
    std::mutex mutex_; // guards parted_
};

} // namespace

static void own_texels(Page& page) {
    if (page.texels.empty()) // what it borrows is not ours to write
        page.texels.assign(page.borrowed.begin(), page.borrowed.end());
    page.borrowed = {};
}

void renumber(Page& page, uint32_t added) {
    constexpr size_t kUnitGrain = 4096; // units a task
    own_texels(page);
    parallel_for(page.units(), kUnitGrain, [&](size_t begin, size_t end) {
        for (size_t unit = begin; unit < end; ++unit) {
            uvec4* const texel = page.texels.data() + unit * OVC_UNIT_TEXELS;
            if (!(texel[3].w & OVC_PAIR))
                continue;
            texel[0].w += added;
            texel[1].w += texel[1].w == OVC_NO_TRIANGLE ? 0 : added;
        }
    });
}

std::optional<RefitCost> refit_page(Page& page, const Soup& soup, const Numbering& numbers,
                                    const Leaf& leaf, const NumberSet* moved,
                                    std::vector<uint32_t>& parted) {
    assert(page.units() > OVC_ROOT_UNIT);
    if (page.has_loose_pairs())
        return std::nullopt;
    own_texels(page);
    return Refitter(page, soup, numbers, leaf, moved, parted).refit();
}

} // namespace ovc
