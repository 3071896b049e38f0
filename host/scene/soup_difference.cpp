// SPDX-License-Identifier: Apache-2.0
// Compares two soups chunk by chunk and corner by corner, in bits.
#include "host/scene/soup_difference.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace ovc {
namespace {

/// Triangles that do not move between two that do are told as moved too, up to so many: a range
/// costs more than they do.
constexpr uint32_t kMaxGap = 32;

/// Returns for each chunk the first one whose corners lie at the same place in memory: itself, or
/// the one that lends it its corners.
std::vector<uint32_t> lenders(const Soup& soup) {
    std::map<std::pair<const void*, uint32_t>, uint32_t> found;
    std::vector<uint32_t> all;
    for (uint32_t i = 0; i < soup.chunks.size(); ++i) {
        const Chunk& chunk = soup.chunks[i];
        all.push_back(
            chunk.size() == 0
                ? i
                : found.try_emplace({chunk.address_of(0), chunk.size()}, i).first->second);
    }
    return all;
}

std::span<const std::byte> bytes_of(const Chunk& chunk) {
    return chunk.double_corners().empty() ? std::as_bytes(chunk.corners())
                                          : std::as_bytes(chunk.double_corners());
}

bool same_bits(const dvec3& a, const dvec3& b) {
    return std::memcmp(&a, &b, sizeof(dvec3)) == 0;
}

bool same_transform(const Chunk& a, const Chunk& b) {
    const Transform *first = a.transform(), *second = b.transform();
    return first && second ? std::memcmp(first, second, sizeof(Transform)) == 0 : first == second;
}

/// Returns the ranges of triangles of the chunk with other corners than in the next frame.
std::vector<PrimRange> moved_ranges(uint32_t mesh, const Chunk& now, const Chunk& next) {
    const std::span<const std::byte> a = bytes_of(now), b = bytes_of(next);
    assert(a.size() == b.size());
    std::vector<PrimRange> ranges;
    const size_t stride = now.size() > 0 ? a.size() / now.size() : 0;
    for (uint32_t prim = 0; prim < now.size(); ++prim) {
        if (std::memcmp(&a[prim * stride], &b[prim * stride], stride) == 0)
            continue;
        if (ranges.empty() || prim - ranges.back().end > kMaxGap)
            ranges.push_back({mesh, prim, prim});
        ranges.back().end = prim + 1;
    }
    return ranges;
}

class Comparison {
public:
    Comparison(const Soup& now, const Soup& next)
        : now_(now), next_(next), lender_(lenders(now)), next_lender_(lenders(next)) {}

    SoupDifference run() {
        SoupDifference result;
        const size_t both = std::min(now_.chunks.size(), next_.chunks.size());
        std::vector<std::vector<PrimRange>> moved; // by chunk
        while (result.kept < both && is_kept(result.kept)) {
            const uint32_t i = result.kept, lender = lender_[i];
            moved.push_back(lender == i ? moved_ranges(i, now_.chunks[i], next_.chunks[i])
                                        : moved[lender]);
            if (!moved[i].empty() && !now_.chunks[lender].owns_corners())
                break; // nobody may write to them
            for (PrimRange range : moved[i])
                result.moved.push_back({i, range.first, range.end});
            if (!same_transform(now_.chunks[i], next_.chunks[i]))
                result.placed.push_back(i);
            ++result.kept;
        }
        result.removed = uint32_t(now_.chunks.size()) - result.kept;
        result.added = uint32_t(next_.chunks.size()) - result.kept;
        return result;
    }

private:
    /// Returns whether the chunk may stay, whatever its corners and its transform are.
    bool is_kept(uint32_t i) const {
        const Chunk &a = now_.chunks[i], &b = next_.chunks[i];
        return a.size() == b.size() && bytes_of(a).size() == bytes_of(b).size() &&
               same_bits(a.origin(), b.origin()) && a.mask() == b.mask() &&
               lender_[i] == next_lender_[i] &&
               (lender_[i] == i || !a.owns_corners()); // the lender owns them, or nobody does
    }

    const Soup& now_;
    const Soup& next_;
    const std::vector<uint32_t> lender_, next_lender_;
};

/// Gives the triangles of a range the corners that they have in `next`.
void move_corners(Chunk& now, const Chunk& next, const PrimRange& range) {
    const size_t first = size_t(range.first) * 3, count = size_t(range.end - range.first) * 3;
    if (now.double_corners().empty())
        now.set_corners(range.first, next.corners().subspan(first, count));
    else
        now.set_corners(range.first, next.double_corners().subspan(first, count));
}

std::optional<Transform> transform_of(const Chunk& chunk) {
    return chunk.transform() ? std::optional(*chunk.transform()) : std::nullopt;
}

/// Returns the chunk with the same corners where the lender has them.
Chunk borrowed(const Chunk& chunk, const Chunk& lender) {
    Chunk same = chunk.double_corners().empty()
                     ? Chunk::borrowing(chunk.origin(), lender.corners())
                     : Chunk::borrowing_doubles(chunk.origin(), lender.double_corners());
    same.place_anew(transform_of(chunk));
    same.set_mask(chunk.mask());
    return same;
}

} // namespace

SoupDifference difference(const Soup& now, const Soup& next) {
    return Comparison(now, next).run();
}

std::vector<Chunk> take_over(Soup& now, Soup next, const SoupDifference& difference) {
    const std::vector<uint32_t> lender = lenders(next);
    for (const PrimRange& range : difference.moved)
        if (lender[range.mesh] == range.mesh)
            move_corners(now.chunks[range.mesh], next.chunks[range.mesh], range);
    for (const uint32_t i : difference.placed)
        now.chunks[i].place_anew(transform_of(next.chunks[i]));
    const auto from = now.chunks.begin() + ptrdiff_t(difference.kept);
    std::vector<Chunk> removed(std::make_move_iterator(from),
                               std::make_move_iterator(now.chunks.end()));
    now.chunks.erase(from, now.chunks.end());
    for (uint32_t i = difference.kept; i < next.chunks.size(); ++i) {
        const bool lender_stays = lender[i] < difference.kept;
        now.chunks.push_back(lender_stays ? borrowed(next.chunks[i], now.chunks[lender[i]])
                                          : std::move(next.chunks[i]));
    }
    return removed;
}

} // namespace ovc
