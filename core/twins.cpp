// SPDX-License-Identifier: Apache-2.0
// Twins are found by a hash of their corners: a table of bits tells the few triangles whose hash
// may come twice, and only those are sorted and compared.
#include "core/twins.h"

#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>

namespace ovc {
namespace {

constexpr size_t kGrain = 4096; // triangles a task

uint64_t mix(uint64_t x) {
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    x ^= x >> 32;
    return x;
}

uint64_t hash(const dvec3& p) {
    uint64_t h = 0;
    for (int axis = 0; axis < 3; ++axis)
        h = mix(h ^ mix(std::bit_cast<uint64_t>(p[axis] + 0.0))); // + 0 turns -0 into 0
    return h;
}

/// The same for each order of the corners.
uint64_t hash(const Triangle& t) {
    return mix(hash(t[0]) + hash(t[1]) + hash(t[2]));
}

/// A bit a hash, shared between threads.
class BitTable {
public:
    explicit BitTable(size_t bits)
        : words_(std::bit_ceil(bits) / 64 + 1), mask_(std::bit_ceil(bits) - 1) {}

    /// Sets the bit, and tells whether it was set before.
    bool set(uint64_t hash) {
        const uint64_t bit = uint64_t(1) << (hash & 63);
        return words_[(hash & mask_) / 64].fetch_or(bit, std::memory_order_relaxed) & bit;
    }
    bool test(uint64_t hash) const {
        return words_[(hash & mask_) / 64].load(std::memory_order_relaxed) >> (hash & 63) & 1;
    }

private:
    std::vector<std::atomic<uint64_t>> words_;
    uint64_t mask_;
};

struct Suspect {
    uint64_t hash;
    TriangleId id;

    auto operator<=>(const Suspect&) const = default;
};

/// The triangles that share a bit with another, by hash and then id. All twins are among them, and
/// of triangles without a twin about one in sixteen.
std::vector<Suspect> suspects(const Soup& soup, const std::vector<TriangleId>& triangles,
                              BuildProgress* progress) {
    const size_t bits = std::max<size_t>(triangles.size() * 16, 64);
    BitTable once(bits), twice(bits);
    std::vector<uint64_t> hashes(triangles.size());
    parallel_for(triangles.size(), kGrain, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        for (size_t i = first; i < last; ++i) {
            hashes[i] = hash(soup.triangle(triangles[i]));
            if (once.set(hashes[i]))
                twice.set(hashes[i]);
            loop.step();
        }
        loop.finish();
    });
    std::vector<Suspect> found;
    for (size_t i = 0; i < triangles.size(); ++i)
        if (twice.test(hashes[i]))
            found.push_back({hashes[i], triangles[i]});
    parallel_sort(found.begin(), found.end());
    return found;
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

Twins Twins::take_out(const Soup& soup, std::vector<TriangleId>& triangles,
                      BuildProgress* progress) {
    assert(std::is_sorted(triangles.begin(), triangles.end()));
    Twins twins;
    std::vector<TriangleId> out;
    std::vector<Suspect> all = suspects(soup, triangles, progress);
    for (auto first = all.begin(); first != all.end();) {
        // The first of what is left stands for its twins, which come next, in the order of ids;
        // others of the same hash, hardly ever any, follow.
        const auto end =
            std::find_if(first, all.end(), [&](const Suspect& s) { return s.hash != first->hash; });
        const Triangle triangle = soup.triangle(first->id);
        const auto is_twin = [&](const Suspect& s) {
            return same_corners(triangle, soup.triangle(s.id));
        };
        const auto rest =
            std::stable_partition(std::find_if_not(first + 1, end, is_twin), end, is_twin);
        if (rest != first + 1)
            twins.pairs_.push_back({first->id, (first + 1)->id});
        for (auto twin = first + 1; twin != rest; ++twin)
            out.push_back(twin->id);
        first = rest;
    }
    twins.count_ = out.size();
    std::sort(twins.pairs_.begin(), twins.pairs_.end(),
              [](const Pair& a, const Pair& b) { return a.smallest < b.smallest; });
    parallel_sort(out.begin(), out.end());
    auto next = out.begin();
    std::erase_if(triangles, [&](TriangleId id) {
        const bool is_out = next != out.end() && *next == id;
        next += is_out;
        return is_out;
    });
    return twins;
}

Hit Twins::seen(const Soup& soup, const Hit& hit, TriangleId skip) const {
    const TriangleId id = seen(hit.id, skip);
    if (id == hit.id)
        return hit;
    const Triangle from = soup.triangle(hit.id);
    const Triangle to = soup.triangle(id);
    const auto weight = [&](const dvec3& corner) {
        return corner == from[1] ? hit.u : corner == from[2] ? hit.v : 1 - hit.u - hit.v;
    };
    return {hit.t, weight(to[1]), weight(to[2]), id};
}

TriangleId Twins::second(TriangleId id) const {
    const auto at =
        std::lower_bound(pairs_.begin(), pairs_.end(), id, [](const Pair& pair, TriangleId wanted) {
            return pair.smallest < wanted;
        });
    return at != pairs_.end() && at->smallest == id ? at->second : id;
}

} // namespace ovc
