// SPDX-License-Identifier: Apache-2.0
// Pairing: sides meet in a hash table of their end points, and the neighbours found so are the
// candidates. Blocks of triangles are paired in parallel; then the triangles that they left alone
// are paired with each other. Based on: Karp and Sipser 1981, "Maximum matchings in sparse random
// graphs".
#include "gpu/bvh/pairs.h"

#include "core/corner_hash.h"
#include "core/ray.h"
#include "core/system/parallel.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace ovc {
namespace {

uint64_t hash(const vec3& p) {
    // + 0 turns -0 into 0: they are the same corner.
    const uint64_t xy =
        std::bit_cast<uint32_t>(p.x + 0.0f) | uint64_t(std::bit_cast<uint32_t>(p.y + 0.0f)) << 32;
    return mix(mix(xy) ^ std::bit_cast<uint32_t>(p.z + 0.0f));
}

Boxf box_of(const LocalTriangle& t) {
    Boxf box;
    for (const vec3& corner : t)
        box.add(corner);
    return box;
}

/// Whether side i of s is side j of t, in either direction.
bool same_side(const LocalTriangle& s, uint32_t i, const LocalTriangle& t, uint32_t j) {
    const vec3 &a = s[i], &b = s[(i + 1) % 3], &c = t[j], &d = t[(j + 1) % 3];
    return (a == c && b == d) || (a == d && b == c);
}

struct Neighbour {
    uint32_t triangle = kNone; // a place in the block; kNone: there is none worth joining
    uint8_t my_side = 0;
    uint8_t its_side = 0;
    float growth = 0; // of the box, against the boxes of the two
};

/// Sides that still look for a neighbour, by the hash of their two end points: open addressing,
/// linear probing. Side k of a triangle runs from corner k to corner k + 1 and is numbered 3
/// triangle + k.
class OpenSides {
public:
    explicit OpenSides(size_t triangles) : slots_(std::bit_ceil(triangles * 6 + 1), kEmpty) {}

    /// Fetches the slot where looking for this key begins.
    void fetch(uint64_t key) const {
        __builtin_prefetch(&slots_[size_t(key) & (slots_.size() - 1)], 1);
    }

    /// Takes out and returns the side that `fits` among those of this key; if there is none, puts
    /// `side` in and returns kNone.
    /// Looks at a few only: where thousands of triangles lie on one edge, some stay alone.
    template <class Fits>
    uint32_t match_or_add(uint64_t key, uint32_t side, Fits&& fits) {
        const uint64_t tag = key & ~uint64_t(kNone);
        const size_t mask = slots_.size() - 1;
        size_t at = size_t(key) & mask;
        for (int looked = 0; slots_[at] != kEmpty; at = (at + 1) & mask) {
            if (++looked == kMaxLooks)
                return kNone;
            const uint32_t other = uint32_t(slots_[at]);
            if ((slots_[at] & ~uint64_t(kNone)) == tag && other != kTaken && fits(other)) {
                slots_[at] = tag | kTaken; // not empty: probing goes on across it
                return other;
            }
        }
        slots_[at] = tag | side;
        return kNone;
    }

private:
    static constexpr uint64_t kEmpty = ~uint64_t(0);
    static constexpr uint32_t kTaken = kNone - 1;
    static constexpr int kMaxLooks = 64;

    std::vector<uint64_t> slots_; // upper half of the key, side below
};

/// Returns the keys of the three sides.
std::array<uint64_t, 3> side_keys(const LocalTriangle& t) {
    const std::array<uint64_t, 3> h{hash(t[0]), hash(t[1]), hash(t[2])};
    return {mix(h[0] + h[1]), mix(h[1] + h[2]), mix(h[2] + h[0])};
}

/// Returns which own corners the pair's corners 0 and 2 are.
uint32_t order(uint32_t first, uint32_t last) {
    return first | last << 2;
}

TrianglePair single(const LocalTriangle& t, uint32_t id) {
    return {{t[0], t[1], t[2], t[1]}, id, kNone, order(0, 2)};
}

/// a's corner opposite the shared side becomes corner 1, b's becomes corner 3.
TrianglePair joined(const LocalTriangle& a, uint32_t a_id, const LocalTriangle& b, uint32_t b_id,
                    const Neighbour& n) {
    const uint32_t side = n.my_side;
    // The shared side may run either way in b, so its end that is corner 0 is found by position.
    const uint32_t far = (n.its_side + 1u) % 3;
    const bool opposite = b[n.its_side] == a[(side + 1) % 3];
    const uint32_t first_of_b = opposite ? n.its_side : far;
    const uint32_t last_of_b = opposite ? far : n.its_side;
    return {{a[(side + 1) % 3], a[(side + 2) % 3], a[side], b[(n.its_side + 2) % 3]},
            a_id,
            b_id,
            order((side + 1) % 3, side) | order(first_of_b, last_of_b) << 4};
}

/// Triangles that may be joined with each other and with no others.
class Block {
public:
    /// ids: into `triangles`, which is kept.
    Block(std::span<const LocalTriangle> triangles, std::span<const uint32_t> ids)
        : triangles_(triangles),
          ids_(ids),
          boxes_(ids.size()),
          neighbours_(ids.size()),
          free_(ids.size(), 0),
          used_(ids.size(), 0) {
        for (uint32_t i = 0; i < ids.size(); ++i)
            boxes_[i] = box_of(triangle(i));
        find_neighbours();
    }

    /// Appends pairs to `pairs`, and the ids of triangles that are left alone to `alone`.
    void pair(std::vector<TrianglePair>& pairs, std::vector<uint32_t>& alone) {
        for (uint32_t i = 0; i < ids_.size(); ++i)
            if (free_[i] == 1)
                last_chance_.push_back(i);
        for (uint32_t next = 0; next < ids_.size(); ++next) {
            // A triangle with one free neighbour left is served before it has none.
            while (!last_chance_.empty()) {
                const uint32_t i = last_chance_.back();
                last_chance_.pop_back();
                if (free_[i] == 1)
                    serve(i, pairs);
            }
            serve(next, pairs);
        }
        for (uint32_t i = 0; i < ids_.size(); ++i)
            if (!used_[i])
                alone.push_back(ids_[i]);
    }

private:
    const LocalTriangle& triangle(uint32_t i) const { return triangles_[ids_[i]]; }

    /// Finds up to three neighbours of each triangle, one across each side. An edge joins two
    /// triangles; further ones at it pair up among themselves.
    void find_neighbours() {
        OpenSides open(ids_.size());
        constexpr uint32_t kAhead = 4; // triangles between fetching their slots and reading them
        std::array<std::array<uint64_t, 3>, kAhead> keys;
        const uint32_t count = uint32_t(ids_.size());
        for (uint32_t next = 0; next < count + kAhead; ++next) {
            std::array<uint64_t, 3>& at = keys[next % kAhead];
            if (next >= kAhead)
                match_sides(next - kAhead, at, open);
            if (next < count) {
                at = side_keys(triangle(next));
                for (const uint64_t key : at)
                    open.fetch(key);
            }
        }
    }

    /// Finds the neighbours of triangle i among those before it.
    void match_sides(uint32_t i, const std::array<uint64_t, 3>& keys, OpenSides& open) {
        const LocalTriangle& t = triangle(i);
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t other = open.match_or_add(keys[k], 3 * i + k, [&](uint32_t side) {
                return side / 3 != i && same_side(t, k, triangle(side / 3), side % 3);
            });
            if (other != kNone)
                meet(i, k, other / 3, other % 3);
        }
    }

    void meet(uint32_t i, uint32_t my_side, uint32_t j, uint32_t its_side) {
        Boxf both = boxes_[i];
        both.add(boxes_[j]);
        // A joint box up to twice the size of both together is worth it: half the units, half the
        // steps.
        const float growth = both.half_area() - 2 * (boxes_[i].half_area() + boxes_[j].half_area());
        if (growth > 0)
            return;
        neighbours_[i][my_side] = {j, uint8_t(my_side), uint8_t(its_side), growth};
        neighbours_[j][its_side] = {i, uint8_t(its_side), uint8_t(my_side), growth};
        ++free_[i];
        ++free_[j];
    }

    /// Joins i with the free neighbour whose box grows least, if it is free and has one.
    void serve(uint32_t i, std::vector<TrianglePair>& pairs) {
        if (used_[i])
            return;
        const Neighbour* best = nullptr;
        for (const Neighbour& n : neighbours_[i])
            if (n.triangle != kNone && !used_[n.triangle] && (!best || n.growth < best->growth))
                best = &n;
        if (!best)
            return;
        const uint32_t j = best->triangle;
        pairs.push_back(joined(triangle(i), ids_[i], triangle(j), ids_[j], *best));
        take(i);
        take(j);
    }

    void take(uint32_t i) {
        used_[i] = 1;
        for (const Neighbour& n : neighbours_[i])
            if (n.triangle != kNone && --free_[n.triangle] == 1 && !used_[n.triangle])
                last_chance_.push_back(n.triangle);
    }

    const std::span<const LocalTriangle> triangles_;
    const std::span<const uint32_t> ids_;
    std::vector<Boxf> boxes_;
    std::vector<std::array<Neighbour, 3>> neighbours_;
    std::vector<uint8_t> free_; // neighbours of each that are not used yet
    std::vector<uint8_t> used_;
    std::vector<uint32_t> last_chance_;
};

/// The tables of a block of so many triangles stay in a core's cache, which makes pairing faster on
/// one thread as well.
constexpr size_t kBlock = 8192;

} // namespace

std::vector<TrianglePair> pair_triangles(std::span<const LocalTriangle> triangles,
                                         BuildProgress* progress) {
    std::vector<uint32_t> ids(triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    struct Part {
        std::vector<TrianglePair> pairs;
        std::vector<uint32_t> alone;
    };
    // Blocks do not depend on the number of threads, so neither does the result.
    std::vector<Part> parts((ids.size() + kBlock - 1) / kBlock);
    parallel_for(parts.size(), 1, [&](size_t first, size_t last) {
        for (size_t p = first; p < last; ++p) {
            const size_t begin = p * kBlock;
            const size_t count = std::min(kBlock, ids.size() - begin);
            parts[p].pairs.reserve(count / 2);
            Block(triangles, std::span(ids).subspan(begin, count))
                .pair(parts[p].pairs, parts[p].alone);
            add(progress, count);
        }
    });
    std::vector<TrianglePair> pairs;
    pairs.reserve(triangles.size() / 2 + triangles.size() / 8);
    std::vector<uint32_t> alone;
    for (const Part& part : parts) {
        pairs.insert(pairs.end(), part.pairs.begin(), part.pairs.end());
        alone.insert(alone.end(), part.alone.begin(), part.alone.end());
    }
    // Neighbours may lie in different blocks.
    std::vector<uint32_t> single_ids;
    if (parts.size() > 1)
        Block(triangles, alone).pair(pairs, single_ids);
    else
        single_ids = std::move(alone);
    for (const uint32_t id : single_ids)
        pairs.push_back(single(triangles[id], id));
    return pairs;
}

} // namespace ovc
