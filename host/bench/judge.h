// SPDX-License-Identifier: Apache-2.0
// Judges answers that name another triangle than the right ones, in exact arithmetic.
#pragma once

#include "core/ray.h"
#include "core/soup.h"

#include <cstdint>
#include <span>

namespace ovc {

/// How many answers are another than the right one, by kind.
struct Verdicts {
    uint64_t tied = 0;   // names another triangle, which the ray meets at exactly the same t
    uint64_t wrong = 0;  // any other triangle, or a hit where there is none
    uint64_t leaked = 0; // a miss where there is a hit
};

/// Judges the names of nearest hits; a miss names no mesh. rays, answers, right: as many of each
/// (asserted); rays are valid, and `right` names triangles of the soup that they hit. An answer may
/// name a triangle that the soup has not.
Verdicts judge(const Soup& soup, std::span<const Ray> rays, std::span<const TriangleId> answers,
               std::span<const TriangleId> right);

/// Judges occlusion, where nothing ties. answers, right: as many of each (asserted).
Verdicts judge(std::span<const uint8_t> answers, std::span<const uint8_t> right);

} // namespace ovc
