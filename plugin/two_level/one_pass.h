// SPDX-License-Identifier: Apache-2.0
// OnePass: answers a query where all pages are resident, so that one pass of the kernel answers a
// ray. Beside the pass of one part of the rays, the part before is resolved and the next one is
// made ready.
#pragma once

#include "plugin/two_level/pass_runner.h"
#include "plugin/two_level/resolve.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

namespace ovc {

template <class Query>
class OnePass {
public:
    OnePass(const Tracing& tracing, PassRunner& passes, const Query& query)
        : watch_(tracing.watch), passes_(passes), query_(query), resolver_(tracing, query) {}

    Result<Done> run() {
        assert(passes_.all_resident());
        Batch* now = &passes_.batches()[0];
        Batch* other = &passes_.batches()[1];
        other->rays.clear();
        begin(*now);
        size_t traced = 0;
        while (!now->rays.empty()) {
            if (Result<Done> asked = watch_.go_on(traced, query_.rays.size()); !asked)
                return asked;
            const size_t begun = next_;
            const Result<size_t> moved = passes_.pass(*now, {}, [&] {
                resolve(*other);
                begin(*other);
            });
            if (!moved)
                return moved.error();
            traced = begun;
            std::swap(now, other);
        }
        resolve(*other);
        return Done{};
    }

private:
    /// Fills the batch with the next rays of the query that the kernel is to be asked about, or
    /// with none where all have begun.
    void begin(Batch& batch) {
        batch.rays.clear();
        while (batch.rays.empty() && next_ < query_.rays.size())
            begin_part(batch);
    }

    void resolve(const Batch& batch) {
        parallel_for(batch.rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            resolver_.resolve(
                std::span(batch.rays).subspan(from, to - from),
                std::span(batch.answers).subspan(from, to - from), [](auto&&...) { return true; },
                [](auto&&...) {}); // there is no other page
        });
    }

    void begin_part(Batch& batch) {
        const size_t part = passes_.part_rays(query_.rays.size());
        const size_t first = next_, count = std::min(part, query_.rays.size() - first);
        const size_t blocks = (count + kRaysPerTask - 1) / kRaysPerTask;
        // Each block writes its rays from its own beginning, then all are moved together: in order
        // and without holes, whichever thread takes which block.
        batch.rays.resize(count);
        block_rays_.resize(blocks);
        parallel_for(blocks, 1, [&](size_t from, size_t to) {
            for (size_t b = from; b < to; ++b) {
                uint32_t* const rays = batch.rays.data() + b * kRaysPerTask;
                uint32_t n = 0;
                for (size_t i = b * kRaysPerTask; i < std::min((b + 1) * kRaysPerTask, count); ++i)
                    if (resolver_.begins(uint32_t(first + i)))
                        rays[n++] = uint32_t(first + i);
                block_rays_[b] = n;
            }
        });
        size_t asked = 0;
        for (size_t b = 0; b < blocks; ++b) {
            const auto rays = batch.rays.begin() + ptrdiff_t(b * kRaysPerTask);
            std::copy(rays, rays + block_rays_[b], batch.rays.begin() + ptrdiff_t(asked));
            asked += block_rays_[b];
        }
        batch.rays.resize(asked);
        next_ += count;
        load(batch);
    }

    void load(Batch& batch) const {
        batch.make_room();
        parallel_for(batch.rays.size(), kRaysPerTask, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const double all = std::numeric_limits<double>::infinity();
                batch.states[j] = resolver_.ray_state(batch.rays[j], all, 0);
            }
        });
    }

    CallWatch& watch_;
    PassRunner& passes_;
    const Query query_;
    Resolver<Query> resolver_;
    size_t next_ = 0; // the first ray of the query that has not begun
    std::vector<uint32_t> block_rays_;
};

} // namespace ovc
