// SPDX-License-Identifier: Apache-2.0
// The mixed form of tracing, as the tracer and its host see it: rays go in at any time, and answers
// come back in any order. Based on: thesis, section 3.5 (algorithm 6).
#pragma once

#include "core/ray.h"
#include "core/result.h"
#include "core/sieve.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

/// The rays of one push into a stream.
struct StreamRays {
    bool any_hit = false; // occlusion, not the nearest hit
    std::span<const Ray> rays;
    std::span<const TriangleId> skip;         // empty, or per ray the triangle it does not see
    std::span<const uint64_t> tokens;         // per ray the host's name for its answer
    std::span<const Hit> after = {};          // empty, or per ray as in Exclusions
    std::span<const uint32_t> masks = {};     // empty, or per ray
    std::span<HitFilter* const> filters = {}; // empty, per ray, or one for all

    /// Whether they are no more than rays and the triangles that these do not see.
    bool are_plain() const { return after.empty() && masks.empty() && filters.empty(); }
};

/// Takes the host's rays.
class RayStream {
public:
    /// Copies the rays and all that belongs to them.
    virtual void push(const StreamRays& rays) = 0;

protected:
    ~RayStream() = default;
};

/// The host of a stream. Each function may push rays; returning false stops the stream.
class StreamHost {
public:
    /// Asks the host for new rays, about `wanted` of them. If it pushes none, there are no more,
    /// and it is not asked again.
    virtual bool more(RayStream& stream, size_t wanted) = 0;
    virtual bool hits(RayStream& stream, std::span<const uint64_t> tokens,
                      std::span<const Hit> hits) = 0;
    virtual bool occlusions(RayStream& stream, std::span<const uint64_t> tokens,
                            std::span<const uint8_t> occluded) = 0;

protected:
    ~StreamHost() = default;
};

/// Returns the error that a stream ends with when its host returns false.
inline Error stopped_by_host() {
    return {"the stream was stopped by its host", ErrorKind::Cancelled};
}

} // namespace ovc
