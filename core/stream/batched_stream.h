// SPDX-License-Identifier: Apache-2.0
// BatchedStream: a stream over a structure that only knows batches. It traces whatever was pushed,
// one batch after the other.
#pragma once

#include "core/exclusions.h"
#include "core/result.h"
#include "core/stream/backlog.h"

#include <algorithm>

namespace ovc {

/// Batches has intersect() and occluded() as plugin/structure/structure.h declares them.
template <class Batches>
class BatchedStream final : public RayStream {
public:
    BatchedStream(Batches& batches, StreamHost& host) : batches_(batches), host_(host) {}

    void push(const StreamRays& rays) override { (rays.any_hit ? any_ : nearest_).push(rays); }

    Result<Done> run() {
        bool more = true;
        while (true) {
            if (more && nearest_.size() + any_.size() == 0) {
                if (!host_.more(*this, kMaxAtOnce))
                    return stopped_by_host();
                more = nearest_.size() + any_.size() > 0;
            }
            if (nearest_.size() + any_.size() == 0)
                return Done{};
            // Occlusion rays go first, because they have no children.
            if (any_.size() > 0) {
                if (Result<Done> done = trace_any(); !done)
                    return done;
            } else if (Result<Done> done = trace_nearest(); !done) {
                return done;
            }
        }
    }

private:
    Result<Done> trace_any() {
        const size_t count = std::min(any_.size(), kMaxAtOnce);
        const StreamRays rays = any_.last(count);
        occluded_.resize(count);
        if (Result<Done> done = batches_.occluded(rays.rays, excluded(rays), occluded_); !done)
            return done;
        const std::vector<uint64_t> tokens(rays.tokens.begin(), rays.tokens.end());
        any_.drop_last(count);
        if (!host_.occlusions(*this, tokens, occluded_))
            return stopped_by_host();
        return Done{};
    }

    Result<Done> trace_nearest() {
        const size_t count = std::min(nearest_.size(), kMaxAtOnce);
        const StreamRays rays = nearest_.last(count);
        hits_.resize(count);
        if (Result<Done> done = batches_.intersect(rays.rays, excluded(rays), hits_); !done)
            return done;
        const std::vector<uint64_t> tokens(rays.tokens.begin(), rays.tokens.end());
        nearest_.drop_last(count);
        if (!host_.hits(*this, tokens, hits_))
            return stopped_by_host();
        return Done{};
    }

    static Exclusions excluded(const StreamRays& rays) {
        Exclusions without(rays.skip, rays.after);
        without.sieves = {rays.masks, rays.filters, rays.tokens};
        return without;
    }

    static constexpr size_t kMaxAtOnce = size_t(1) << 20; // rays per batch

    Batches& batches_;
    StreamHost& host_;
    Backlog nearest_;
    Backlog any_;
    std::vector<Hit> hits_;
    std::vector<uint8_t> occluded_;
};

/// Traces the rays that the host pushes until it has no more. Error: that of the batch that failed,
/// or one of the kind Cancelled where the host stopped the stream.
template <class Batches>
Result<Done> stream_in_batches(Batches& batches, StreamHost& host) {
    return BatchedStream<Batches>(batches, host).run();
}

} // namespace ovc
