// SPDX-License-Identifier: Apache-2.0
// JoinedRays: rays of several callers, side by side, so that a structure answers them in one call.
#pragma once

#include "core/exclusions.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ovc {

class JoinedRays {
public:
    explicit JoinedRays(size_t count) : rays_(count), skip_(count), after_(count, kBeforeAll) {}

    /// Sets ray i. Several threads may set different rays.
    void set(size_t i, const Ray& ray, const Exclusion& without) {
        rays_[i] = ray;
        skip_[i] = without.skip;
        after_[i] = without.after.as_hit();
    }
    const std::vector<Ray>& rays() const { return rays_; }
    /// Returns what they exclude. Nothing where no ray does, for that is faster.
    Exclusions without() const {
        const bool skips =
            std::ranges::any_of(skip_, [](const TriangleId& id) { return !(id == TriangleId()); });
        const bool goes_on = std::ranges::any_of(
            after_, [](const Hit& hit) { return !HitPlace(hit).is_before_all(); });
        return Exclusions(skips ? std::span(skip_) : std::span<const TriangleId>(),
                          goes_on ? std::span(after_) : std::span<const Hit>());
    }

private:
    std::vector<Ray> rays_;
    std::vector<TriangleId> skip_;
    std::vector<Hit> after_;
};

} // namespace ovc
