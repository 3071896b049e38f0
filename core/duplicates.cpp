// SPDX-License-Identifier: Apache-2.0
// Duplicates are found by a hash of their corners: a table of bits tells the few triangles whose
// hash may come twice, and only those are sorted and compared. Each thread has its part of the
// hashes and a table of its own, because the cache lines of a shared table would go from core to
// core for every other triangle.
#include "core/duplicates.h"

#include "core/corner_hash.h"
#include "core/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

namespace ovc {
namespace {

constexpr size_t kHashGrain = 4096; // triangles per task

/// A table of one bit per hash, which the bits of the hash above `shift` select.
class BitTable {
public:
    BitTable(size_t bits, int shift)
        : words_(std::bit_ceil(bits) / 64), mask_(std::bit_ceil(bits) - 1), shift_(shift) {}

    /// Sets the bit if `really`, and returns whether it was set before.
    bool set(uint64_t hash, bool really = true) {
        const uint64_t at = hash >> shift_ & mask_;
        const uint64_t before = words_[at / 64];
        words_[at / 64] = before | uint64_t(really) << (at & 63);
        return before >> (at & 63) & 1;
    }
    bool test(uint64_t hash) const {
        const uint64_t at = hash >> shift_ & mask_;
        return words_[at / 64] >> (at & 63) & 1;
    }

private:
    std::vector<uint64_t> words_;
    uint64_t mask_;
    int shift_;
};

struct Suspect {
    uint64_t hash;
    TriangleId id;

    auto operator<=>(const Suspect&) const = default;
};

/// One of `count` parts of all hashes.
struct Part {
    size_t number;
    size_t count;

    bool has(uint64_t hash) const { return (hash >> 32) * count >> 32 == number; }
};

/// Returns the triangles of this part that may belong to a set, sorted by hash and then id: all
/// duplicates, and about one in sixteen of the others. hashes[i] is that of triangles[i].
std::vector<Suspect> suspects(const Part& part, std::span<const TriangleId> triangles,
                              std::span<const uint64_t> hashes) {
    assert(hashes.size() == triangles.size() && part.number < part.count);
    const size_t some = std::max<size_t>(triangles.size() / part.count, 64);
    // The tables use different bits of the hash: hashes that collide in one hardly ever do in both.
    BitTable came(16 * some, 0), came_again(some, 24);
    // The loop does not branch on whether a hash is in the part, because no CPU could predict that.
    for (const uint64_t h : hashes) {
        const bool mine = part.has(h);
        if (mine & came.set(h, mine))
            came_again.set(h);
    }
    std::vector<Suspect> found;
    for (size_t i = 0; i < hashes.size(); ++i)
        if (part.has(hashes[i]) & came_again.test(hashes[i]))
            found.push_back({hashes[i], triangles[i]});
    std::sort(found.begin(), found.end());
    return found;
}

/// Returns the duplicates among those that may be some.
std::vector<Duplicates::Pair> compared(const Soup& soup, std::vector<Suspect> all) {
    std::vector<Duplicates::Pair> pairs;
    for (auto first = all.begin(); first != all.end();) {
        // The first triangle left stands for its duplicates, which come next, in the order of ids.
        // Others of the same hash, of which there are hardly any, follow.
        const auto end =
            std::find_if(first, all.end(), [&](const Suspect& s) { return s.hash != first->hash; });
        if (end == first + 1) {
            first = end;
            continue;
        }
        const Triangle triangle = soup.triangle(first->id);
        const auto is_duplicate = [&](const Suspect& s) {
            return same_corners(triangle, soup.triangle(s.id));
        };
        const auto rest = std::stable_partition(std::find_if_not(first + 1, end, is_duplicate), end,
                                                is_duplicate);
        for (auto duplicate = first + 1; duplicate != rest; ++duplicate)
            pairs.push_back({first->id, duplicate->id});
        first = rest;
    }
    return pairs;
}

std::vector<uint64_t> hashes_of(const Soup& soup, std::span<const TriangleId> triangles,
                                BuildProgress* progress) {
    std::vector<uint64_t> hashes(triangles.size());
    parallel_for(triangles.size(), kHashGrain, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        for (size_t i = first; i < last; ++i, loop.step())
            hashes[i] = triangle_hash(soup.triangle(triangles[i]));
        loop.finish();
    });
    return hashes;
}

} // namespace

bool same_corners(const Triangle& a, const Triangle& b) {
    for (int turn = 0; turn < 3; ++turn) {
        const dvec3& first = b[turn];
        const dvec3& second = b[(turn + 1) % 3];
        const dvec3& third = b[(turn + 2) % 3];
        if (a[0] == first &&
            ((a[1] == second && a[2] == third) || (a[1] == third && a[2] == second)))
            return true;
    }
    return false;
}

Duplicates Duplicates::take_out(const Soup& soup, std::vector<TriangleId>& triangles,
                                BuildProgress* progress) {
    assert(std::is_sorted(triangles.begin(), triangles.end()));
    const std::vector<uint64_t> hashes = hashes_of(soup, triangles, progress);
    std::vector<std::vector<Pair>> found(thread_count());
    parallel_for(found.size(), 1, [&](size_t first, size_t last) {
        for (size_t p = first; p < last; ++p)
            found[p] = compared(soup, suspects({p, found.size()}, triangles, hashes));
    });
    Duplicates duplicates;
    for (const std::vector<Pair>& part : found)
        duplicates.pairs_.insert(duplicates.pairs_.end(), part.begin(), part.end());
    if (duplicates.pairs_.empty())
        return duplicates;
    parallel_sort(duplicates.pairs_.begin(), duplicates.pairs_.end());
    std::vector<TriangleId> out;
    out.reserve(duplicates.pairs_.size());
    for (const Pair& pair : duplicates.pairs_)
        out.push_back(pair.other);
    parallel_sort(out.begin(), out.end());
    auto next = out.begin();
    std::erase_if(triangles, [&](TriangleId id) {
        const bool is_out = next != out.end() && *next == id;
        next += is_out;
        return is_out;
    });
    assert(triangles.size() + out.size() == hashes.size());
    return duplicates;
}

Hit as_hit_of(TriangleId id, const Soup& soup, const Hit& hit) {
    if (id == hit.id)
        return hit;
    const Triangle from = soup.triangle(hit.id);
    const Triangle to = soup.triangle(id);
    const auto weight = [&](const dvec3& corner) {
        return corner == from[1] ? hit.u : corner == from[2] ? hit.v : 1 - hit.u - hit.v;
    };
    return {hit.t, weight(to[1]), weight(to[2]), id};
}

std::span<const Duplicates::Pair> Duplicates::of(TriangleId id) const {
    const auto first = std::ranges::lower_bound(pairs_, id, {}, &Pair::smallest);
    const auto last = std::ranges::upper_bound(pairs_, id, {}, &Pair::smallest);
    return {first, last};
}

} // namespace ovc
