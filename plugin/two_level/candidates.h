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

    /// Offers all of them, each as a ray sees it that does not see `skip`. Returns false where
    /// exact arithmetic does not confirm the certain hit: then the kernel's answer cannot be
    /// trusted, and the ray goes to the exact fallback.
    bool offer_to(Nearest& nearest, const BuiltScene& scene, TriangleId skip) const {
        if (certain != OVC_MISS && !scene.offer(nearest, scene.seen(certain, skip)))
            return false;
        for (const uint32_t number : further)
            if (number != OVC_NO_TRIANGLE)
                scene.offer(nearest, scene.seen(number, skip));
        return true;
    }
};

} // namespace ovc
