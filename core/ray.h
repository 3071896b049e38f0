// SPDX-License-Identifier: Apache-2.0
// Ray and Hit, in double: the records of the C ABI, byte for byte (plugin/abi/plugin.cpp asserts
// it).
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace ovc {

/// The mesh and the prim of no triangle.
inline constexpr uint32_t kNone = 0xffffffffu;

/// Names a triangle by the number of its mesh and its own number in it. Ordered by mesh, then prim.
struct TriangleId {
    uint32_t mesh = kNone;
    uint32_t prim = kNone;

    auto operator<=>(const TriangleId&) const = default;
};

/// Where the largest component of a direction is shorter or longer, products of it, or of a t, with
/// lengths may leave the range of doubles. Exact arithmetic begins such a ray anew
/// (kdtree/approach.h).
inline constexpr double kMinWalkedDirection = 0x1p-500, kMaxWalkedDirection = 0x1p500;

/// The points org + t dir with t_min <= t <= t_max. dir need not be of unit length; t counts in its
/// lengths.
struct Ray {
    dvec3 org{0};
    double t_min = 0;
    dvec3 dir{0, 0, 1};
    double t_max = std::numeric_limits<double>::infinity();

    dvec3 at(double t) const { return org + t * dir; }

    /// Returns false for a ray that no triangle can be tested against: NaN or infinity in org, dir
    /// or t_min, NaN in t_max, t_min > t_max, a direction that is zero or so short that its
    /// reciprocal overflows (below 1e-300). Such a ray is a miss.
    bool valid() const {
        const dvec3 length = glm::abs(dir);
        return is_finite(org) && is_finite(dir) && std::isfinite(t_min) && t_min <= t_max &&
               max_component(length) >= 1e-300;
    }
};
static_assert(sizeof(Ray) == 64 && offsetof(Ray, dir) == 32);

/// A hit at org + t dir = (1 - u - v) a + u b + v c of triangle (a, b, c); a miss has mesh == prim
/// == kNone.
struct Hit {
    double t = std::numeric_limits<double>::infinity();
    double u = 0;
    double v = 0;
    TriangleId id;

    bool is_hit() const { return id.mesh != kNone; }

    /// Returns whether this hit of a ray wins: by smaller t, ties by the smaller (mesh, prim).
    bool nearer_than(const Hit& other) const {
        return t < other.t || (t == other.t && id < other.id);
    }
};
static_assert(sizeof(Hit) == 32 && offsetof(Hit, id) == 24);

/// Two-level's notes on rays besides their hits. Each span is empty, or has an entry per ray.
struct RayNotes {
    std::span<uint32_t> leaf;    // the level-1 leaf in which the hit lies; kNone: a miss
    std::span<uint32_t> passes;  // the number of passes that the ray took part in
    std::span<uint32_t> flagged; // 1: the kernel left an answer to doubles; else 0

    bool any() const { return !leaf.empty() || !passes.empty() || !flagged.empty(); }
};

} // namespace ovc
