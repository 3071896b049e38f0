// SPDX-License-Identifier: Apache-2.0
// Pairing: edges are sorted by their end points, equal neighbours are the candidates.
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

/// Side k of a triangle runs from corner k to corner k + 1.
struct Side {
    uint64_t key; // of its two end points, in either order
    uint32_t triangle;
    uint32_t side;
};

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

/// Up to three neighbours of each triangle, one across each side.
std::vector<std::array<Neighbour, 3>> neighbours(std::span<const LocalTriangle> triangles) {
    std::vector<Side> sides;
    sides.reserve(triangles.size() * 3);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        std::array<uint64_t, 3> h;
        for (int k = 0; k < 3; ++k)
            h[k] = hash(triangles[i][k]);
        for (uint32_t k = 0; k < 3; ++k)
            sides.push_back({h[k] + h[(k + 1) % 3], i, k});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
    });
    std::vector<std::array<Neighbour, 3>> result(triangles.size());
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side& s = sides[i];
        const Side& t = sides[i + 1];
        if (s.key != t.key || s.triangle == t.triangle ||
            !same_side(triangles[s.triangle], s.side, triangles[t.triangle], t.side))
            continue;
        result[s.triangle][s.side] = {t.triangle, s.side, t.side};
        result[t.triangle][t.side] = {s.triangle, t.side, s.side};
        ++i; // an edge joins two triangles; further ones at it pair up among themselves
    }
    return result;
}

TrianglePair single(const LocalTriangle& t, uint32_t id) {
    return {{t[0], t[1], t[2], t[1]}, id, kNone};
}

/// a's corner opposite the shared side becomes corner 1, b's becomes corner 3.
TrianglePair joined(const LocalTriangle& a, uint32_t a_id, const LocalTriangle& b,
                    const Neighbour& n) {
    const uint32_t side = n.my_side;
    return {
        {a[(side + 1) % 3], a[(side + 2) % 3], a[side], b[(n.its_side + 2) % 3]}, a_id, n.triangle};
}

} // namespace

std::vector<TrianglePair> pair_triangles(std::span<const LocalTriangle> triangles) {
    const auto candidates = neighbours(triangles);
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
