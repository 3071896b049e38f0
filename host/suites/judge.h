// SPDX-License-Identifier: Apache-2.0
// Judges answers that name another triangle than the right ones, in exact arithmetic.
#pragma once

#include "core/ray.h"
#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Counts of answers that are not the right one, by kind.
struct Verdicts {
    uint64_t tied = 0;   // names another triangle, which the ray meets at exactly the same t
    uint64_t wrong = 0;  // any other triangle, or a hit where there is none
    uint64_t beside = 0; // of wrong: at most kBesideUlps off in t, so the same point for a float
    uint64_t leaked = 0; // a miss where there is a hit
};

/// Returns whether the ray meets both triangles at exactly the same t. ray: valid. right: is hit.
bool is_tied(const Ray& ray, const Triangle& named, const Triangle& right);

inline constexpr double kBesideUlps = 4;

/// Returns |t - right| in units of the last place of a float at `right`; 0 where that is 0.
double float_ulps(double t, double right);

/// Nearest hits: each names a triangle, or no mesh for a miss, and t.
struct NamedHits {
    std::vector<TriangleId> names;
    std::span<const double> t;
};

/// Judges nearest hits. rays, answers, right: as many of each (asserted); rays are valid, and
/// `right` names triangles of the soup that they hit. An answer may name a triangle that the soup
/// has not.
Verdicts judge(const Soup& soup, std::span<const Ray> rays, const NamedHits& answers,
               const NamedHits& right);

/// Judges occlusion, where nothing ties. answers, right: as many of each (asserted).
Verdicts judge(std::span<const uint8_t> answers, std::span<const uint8_t> right);

} // namespace ovc
