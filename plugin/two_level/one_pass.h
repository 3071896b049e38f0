// SPDX-License-Identifier: Apache-2.0
// OnePass: answers a query where all pages are resident, so that one pass of the kernel answers a
// ray. While one part of the rays is with the kernel and the next one waits for it, the part before
// is resolved and the one behind is made ready, so that the kernel never waits for the host. Nor
// does the host wait for the first part before three are on their way.
#pragma once

#include "plugin/resolve/resolve.h"
#include "plugin/two_level/pass_runner.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <vector>

namespace ovc {

template <class Query>
class OnePass {
public:
    /// Answers `count` rays of the query, `first` and those behind it. Rays go by numbers of 32
    /// bits, which count from `first`.
    OnePass(const Tracing& tracing, PassRunner& passes, const Query& query, size_t first,
            size_t count)
        : watch_(tracing.watch),
          passes_(passes),
          query_(query.part(first, count)),
          rays_before_(first),
          rays_of_call_(query.rays.size()),
          resolver_(tracing, query_, /* are_whole= */ true) {
        assert(count <= size_t(1) << 32);
    }

    Result<Done> run() {
        assert(passes_.all_resident());
        const PassRunner::Scope scope(passes_);
        auto& batches = passes_.batches();
        size_t begun = 0, finished = 0; // passes
        const auto begin_next = [&] {
            Batch& next = batches[begun % batches.size()];
            fill(next);
            if (next.rays.empty())
                return;
            passes_.begin_pass(next, {});
            ++begun;
        };
        for (size_t i = 0; i < batches.size(); ++i)
            begin_next();
        size_t traced = 0;
        while (finished < begun) {
            if (Result<Done> asked = watch_.go_on(rays_before_ + traced, rays_of_call_); !asked)
                return asked;
            Batch& done = batches[finished++ % batches.size()];
            if (const Result<Done> passed = passes_.finish_pass(done); !passed)
                return passed;
            resolve(done);
            traced = size_t(done.rays.back()) + 1;
            begin_next();
        }
        return Done{};
    }

private:
    /// Fills the batch with the next rays of the query that the kernel is to be asked about; with
    /// none where all have begun.
    void fill(Batch& batch) {
        batch.rays.clear();
        while (batch.rays.empty() && next_ < query_.rays.size())
            fill_part(batch);
    }

    void resolve(const Batch& batch) {
        parallel_for(batch.rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            resolver_.resolve(
                std::span(batch.rays).subspan(from, to - from), batch.answers, from,
                [](auto&&...) { return true; }, [](auto&&...) {}); // there is no other page
        });
    }

    void fill_part(Batch& batch) {
        const size_t part = passes_.part_rays(query_.rays.size());
        const size_t first = next_, count = std::min(part, query_.rays.size() - first);
        const size_t blocks = (count + kRaysPerTask - 1) / kRaysPerTask;
        // Each block writes its rays from its own beginning, then all are moved together: in order
        // and without holes, whichever thread takes which block.
        batch.rays.resize(count);
        batch.make_room(passes_.form());
        batch.sent.set_all_any_hit(Query::kAnyHit);
        block_rays_.resize(blocks);
        parallel_for(blocks, 1, [&](size_t from, size_t to) {
            for (size_t b = from; b < to; ++b)
                block_rays_[b] = fill_block(batch, first, b * kRaysPerTask);
        });
        size_t asked = 0;
        for (size_t b = 0; b < blocks; ++b) {
            const auto rays = batch.rays.begin() + ptrdiff_t(b * kRaysPerTask);
            std::copy(rays, rays + ptrdiff_t(block_rays_[b]),
                      batch.rays.begin() + ptrdiff_t(asked));
            asked += block_rays_[b];
        }
        batch.rays.resize(asked);
        batch.sent.close_holes(kRaysPerTask, block_rays_);
        next_ += count;
    }

    /// Begins the rays of the block at the place `first` of the part whose first ray is `part`, and
    /// writes those that the kernel is to be asked about from that place on; returns how many.
    size_t fill_block(Batch& batch, size_t part, size_t first) {
        const size_t count = std::min(kRaysPerTask, batch.rays.size() - first);
        const std::span<uint32_t> rays = std::span(batch.rays).subspan(first, count);
        std::iota(rays.begin(), rays.end(), uint32_t(part + first));
        size_t asked = 0;
        resolver_.in_lanes(rays, [&](RayStates& states, std::span<const uint32_t> some, size_t j) {
            const uint32_t begins = resolver_.begins(states, some);
            resolver_.send(batch.sent, first + asked, states, some, begins);
            if (asked == j && begins == RayLanes::first(some.size())) {
                asked += some.size(); // they are in their places
                return;
            }
            for (size_t lane = 0; lane < some.size(); ++lane)
                if (begins >> lane & 1)
                    rays[asked++] = some[lane];
        });
        return asked;
    }

    CallWatch& watch_;
    PassRunner& passes_;
    const Query query_;
    const size_t rays_before_; // of the call
    const size_t rays_of_call_;
    Resolver<Query> resolver_;
    size_t next_ = 0; // the first ray of the query that has not begun
    std::vector<size_t> block_rays_;
};

/// Answers the query by one OnePass for each options.max_numbered_rays rays of it.
template <class Query>
Result<Done> trace_in_one_pass(const Tracing& tracing, PassRunner& passes, const Query& query) {
    const size_t max = tracing.options.max_numbered_rays;
    for (size_t first = 0; first < query.rays.size(); first += max) {
        const size_t count = std::min(max, query.rays.size() - first);
        if (Result<Done> done = OnePass(tracing, passes, query, first, count).run(); !done)
            return done;
    }
    return Done{};
}

} // namespace ovc
