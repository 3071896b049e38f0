// SPDX-License-Identifier: Apache-2.0
// Candidates: the triangles that a kernel found for a ray in certified precision, and the rule by
// which exact arithmetic decides among them. Two-level and the systems of plugin/thesis share the
// rule.
#pragma once

#include "plugin/build/built_scene.h"

#include <array>

namespace ovc {

/// Triangles by their numbers in the scene.
struct Candidates {
    uint32_t certain;                // the ray hits this one for certain; or OVC_MISS
    std::array<uint32_t, 2> further; // it may hit these as well; OVC_NO_TRIANGLE stands last

    bool has_further() const { return further[0] != OVC_NO_TRIANGLE; }
    bool is_miss() const { return certain == OVC_MISS && !has_further(); }
    /// The kernel is certain that something is hit; nothing is left to decide for an occlusion ray.
    bool is_certain_hit() const { return certain != OVC_MISS && !has_further(); }

    /// Offers all of them to `nearest`, which is of the ray p. Returns false where exact arithmetic
    /// does not confirm the certain hit, or that is not behind p.after: then farther hits may have
    /// been left out, and the ray goes to the exact fallback.
    bool offer_to(Nearest& nearest, const PreparedRay& p, const BuiltScene& scene) const {
        if (certain != OVC_MISS && !scene.offer(nearest, p, scene.numbers.id(certain)))
            return false;
        for (const uint32_t number : further)
            if (number != OVC_NO_TRIANGLE)
                scene.offer(nearest, p, scene.numbers.id(number));
        return true;
    }
};

} // namespace ovc
