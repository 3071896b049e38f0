// SPDX-License-Identifier: Apache-2.0
// HitLanes: computes where several rays meet triangles, and t, u and v of several hits, by the
// widest vectors that the processor has.
#pragma once

#include "core/exact/rounding.h"
#include "core/ray.h"
#include "core/soup.h"

#include <vector>

namespace ovc {

/// Eight rays, which lie elsewhere, and a triangle for each.
struct MeetingLanes {
    static constexpr int kCount = 8;

    /// Coordinate `axis` of corner i lies in [3 i + axis], as Chunk::put_triangle() leaves it.
    alignas(64) double corners[9][kCount];
    const Ray* rays[kCount];

    void set(int lane, const Ray* ray, const Chunk& chunk, uint32_t prim) {
        rays[lane] = ray;
        chunk.put_triangle<kCount>(prim, &corners[0][lane]);
    }
    void set(int lane, const Ray* ray, const Triangle& triangle) {
        rays[lane] = ray;
        for (int i = 0; i < 9; ++i)
            corners[i][lane] = triangle[size_t(i / 3)][i % 3];
    }
    const Ray& ray(int lane) const { return *rays[lane]; }
    Triangle triangle(int lane) const {
        const auto corner = [&](int i) {
            return dvec3(corners[3 * i][lane], corners[3 * i + 1][lane], corners[3 * i + 2][lane]);
        };
        return {corner(0), corner(1), corner(2)};
    }
};

/// Rays that hit their triangles.
struct HitLanes : MeetingLanes {
    /// Bits of `known`. A number that is not known may be anything.
    static constexpr int kT = 1, kU = 2, kV = 4, kAll = kT | kU | kV;

    alignas(64) double t[kCount], u[kCount], v[kCount];
    /// Those of t, u and v that are the exact values, rounded to nearest. For others not even this
    /// precision tells how they round.
    alignas(64) long long known[kCount];
};

/// The points where rays meet the planes of their triangles.
struct SolutionLanes {
    static constexpr int kCount = MeetingLanes::kCount;
    using Number = double[3][kCount]; // the two parts of the number, and a bound of its error

    alignas(64) Number det, u, v, t;
    /// True (-1) where two of u, v and w certainly have different signs: no hit.
    alignas(64) long long missed[kCount];

    BoundedSolution<double> at(int lane) const {
        const auto value = [&](const Number& n) { return DoubleDouble{n[0][lane], n[1][lane]}; };
        return {{value(det), value(u), value(v), value(t)},
                {det[2][lane], u[2][lane], v[2][lane], t[2][lane]}};
    }
};

/// Fills in t, u, v and known of the first `count` lanes. The bits are the same on every processor.
void round_hits(HitLanes& lanes, int count);
/// Solves the first `count` lanes. The bits are the same on every processor, as long as nothing
/// over- or underflows.
void solve(const MeetingLanes& lanes, int count, SolutionLanes& solutions);

/// Returns a function per width of vectors that the processor has, the widest last: for tests.
using RoundHits = void (*)(HitLanes&, int);
std::vector<RoundHits> ways_to_round_hits();
using Solve = void (*)(const MeetingLanes&, int, SolutionLanes&);
std::vector<Solve> ways_to_solve();

} // namespace ovc
