// SPDX-License-Identifier: Apache-2.0
// Pairing: sides meet in a hash table of their end points; the neighbours so found are the
// candidates.
#include "gpu/pairs.h"

#include "core/ray.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace ovc {
namespace {

uint64_t mix(uint64_t x) {
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    x ^= x >> 32;
    return x;
}

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

/// Is side i of s the side j of t, in either direction?
bool same_side(const LocalTriangle& s, uint32_t i, const LocalTriangle& t, uint32_t j) {
    const vec3 &a = s[i], &b = s[(i + 1) % 3], &c = t[j], &d = t[(j + 1) % 3];
    return (a == c && b == d) || (a == d && b == c);
}

struct Neighbour {
    uint32_t triangle = kNone;
    uint32_t my_side = 0;
    uint32_t its_side = 0;
};

/// Sides that still look for a neighbour, by the hash of their two end points: open addressing,
/// linear probing. Side k of a triangle runs from corner k to corner k + 1 and is numbered 3
/// triangle + k.
class OpenSides {
public:
    explicit OpenSides(size_t triangles) : slots_(std::bit_ceil(triangles * 6 + 1), kEmpty) {}

    /// The side that `fits` among those of this key, taken out; or kNone, and `side` is put in.
    /// Looks at a few only: where thousands of triangles lie on one edge, some stay alone.
    template <class Fits>
    uint32_t match_or_add(uint64_t key, uint32_t side, Fits&& fits) {
        const uint64_t tag = key & ~uint64_t(kNone);
        const size_t mask = slots_.size() - 1;
        size_t at = size_t(key) & mask;
        for (int looked = 0; slots_[at] != kEmpty; at = (at + 1) & mask) {
            if (++looked == kMostLooks)
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
    static constexpr int kMostLooks = 64;

    std::vector<uint64_t> slots_; // upper half of the key, side below
};

/// Up to three neighbours of each triangle, one across each side. An edge joins two triangles;
/// further ones at it pair up among themselves.
std::vector<std::array<Neighbour, 3>> neighbours(std::span<const LocalTriangle> triangles,
                                                 BuildProgress* progress) {
    OpenSides open(triangles.size());
    std::vector<std::array<Neighbour, 3>> result(triangles.size());
    LoopProgress loop(progress);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        std::array<uint64_t, 3> h;
        for (int k = 0; k < 3; ++k)
            h[k] = hash(triangles[i][k]);
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t other =
                open.match_or_add(mix(h[k] + h[(k + 1) % 3]), 3 * i + k, [&](uint32_t side) {
                    return side / 3 != i &&
                           same_side(triangles[i], k, triangles[side / 3], side % 3);
                });
            if (other == kNone)
                continue;
            result[i][k] = {other / 3, k, other % 3};
            result[other / 3][other % 3] = {i, other % 3, k};
        }
        loop.step();
    }
    loop.finish();
    return result;
}

/// Which own corners the pair's corners 0 and 2 are.
uint32_t order(uint32_t first, uint32_t last) {
    return first | last << 2;
}

TrianglePair single(const LocalTriangle& t, uint32_t id) {
    return {{t[0], t[1], t[2], t[1]}, id, kNone, order(0, 2)};
}

/// a's corner opposite the shared side becomes corner 1, b's becomes corner 3.
TrianglePair joined(const LocalTriangle& a, uint32_t a_id, const LocalTriangle& b,
                    const Neighbour& n) {
    const uint32_t side = n.my_side;
    // b may have the shared side run either way: its end that is corner 0 is told by position.
    const uint32_t far = (n.its_side + 1) % 3;
    const bool opposite = b[n.its_side] == a[(side + 1) % 3];
    const uint32_t first_of_b = opposite ? n.its_side : far;
    const uint32_t last_of_b = opposite ? far : n.its_side;
    return {{a[(side + 1) % 3], a[(side + 2) % 3], a[side], b[(n.its_side + 2) % 3]},
            a_id,
            n.triangle,
            order((side + 1) % 3, side) | order(first_of_b, last_of_b) << 4};
}

} // namespace

std::vector<TrianglePair> pair_triangles(std::span<const LocalTriangle> triangles,
                                         BuildProgress* progress) {
    const auto candidates = neighbours(triangles, progress);
    std::vector<uint8_t> used(triangles.size(), 0);
    std::vector<TrianglePair> pairs;
    pairs.reserve(triangles.size() / 2 + triangles.size() / 8);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        if (used[i])
            continue;
        const Boxf mine = box_of(triangles[i]);
        const Neighbour* best = nullptr;
        float best_growth = 0; // beyond zero, two boxes are cheaper than one
        for (const Neighbour& n : candidates[i]) {
            if (n.triangle == kNone || used[n.triangle])
                continue;
            const Boxf its = box_of(triangles[n.triangle]);
            Boxf both = mine;
            both.add(its);
            const float two = mine.half_area() + its.half_area();
            // A joint box up to the size of both together is worth it: half the units, half the
            // steps.
            const float growth = both.half_area() - 2 * two;
            if (growth <= 0 && (!best || growth < best_growth)) {
                best = &n;
                best_growth = growth;
            }
        }
        used[i] = 1;
        if (best) {
            used[best->triangle] = 1;
            pairs.push_back(joined(triangles[i], i, triangles[best->triangle], *best));
        } else {
            pairs.push_back(single(triangles[i], i));
        }
    }
    return pairs;
}

} // namespace ovc
