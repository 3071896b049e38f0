// SPDX-License-Identifier: Apache-2.0
// Sieves: which hits of a ray count, by the masks of the ray and of the mesh, and by a filter of
// the host. A hit that does not count is passed by: the ray goes on behind it.
#pragma once

#include "core/ray.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

/// Decides, for a host, which hits count.
class HitFilter {
public:
    /// Sets keep[i], which is 1 before, to 0 where hits[i] of the ray that the host knows as
    /// rays[i] does not count. Returns false to stop the call; it is not asked again then. It is
    /// called from several threads at once, at most once for each hit of a ray.
    virtual bool keep(std::span<const uint64_t> rays, std::span<const Hit> hits,
                      std::span<uint8_t> keep) = 0;

protected:
    ~HitFilter() = default;
};

/// Whether a ray of that mask sees a mesh of this one: they have a bit in common, or one is 0.
inline bool sees(uint32_t ray_mask, uint32_t mesh_mask) {
    return ray_mask == 0 || mesh_mask == 0 || (ray_mask & mesh_mask) != 0;
}

/// The sieve of one ray.
struct RaySieve {
    uint32_t mask = 0;
    HitFilter* filter = nullptr;
    uint64_t name = 0; // of the ray, for the filter

    bool passes_all() const { return mask == 0 && !filter; }
};

/// The sieves of the rays of a call. Each of the arrays is empty or has one element per ray.
struct Sieves {
    std::span<const uint32_t> masks;
    std::span<HitFilter* const> filters; // may also be one for all rays
    std::span<const uint64_t> names;     // empty: rays are named by their numbers
    uint64_t first_name = 0;             // then that of the first one

    bool pass_all() const { return masks.empty() && filters.empty(); }
    RaySieve operator[](size_t i) const {
        return {masks.empty() ? 0 : masks[i],
                filters.empty() ? nullptr : filters[filters.size() == 1 ? 0 : i],
                names.empty() ? first_name + i : names[i]};
    }
    Sieves subspan(size_t first, size_t count) const {
        return {masks.empty() ? masks : masks.subspan(first, count),
                filters.size() <= 1 ? filters : filters.subspan(first, count),
                names.empty() ? names : names.subspan(first, count), first_name + first};
    }
};

} // namespace ovc
