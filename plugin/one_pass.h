// SPDX-License-Identifier: Apache-2.0
// OnePass: a query where all pages are linked, so that one pass of the kernel answers a ray. Beside
// the pass of one part of the rays, the part before is settled and the next one made ready.
#pragma once

#include "plugin/settling.h"

#include <algorithm>
#include <numeric>

namespace ovc {

template <class Query>
class TwoLevel::OnePass : Settling<Query> {
    using Base = Settling<Query>;
    using Base::kGrain;
    using Base::query_;
    using Base::s_;

public:
    OnePass(TwoLevel& structure, const Query& query) : Base(structure, query) {}

    /// The next rays of the query that the kernel is to be asked about; none where all have begun.
    void begin(Batch& batch) {
        batch.rays.clear();
        while (batch.rays.empty() && next_ < query_.rays.size())
            begin_part(batch);
    }

    /// Rays of the query that have begun.
    size_t begun() const { return next_; }

    void settle(const Batch& batch) {
        parallel_for(batch.rays.size(), kGrain, [&](size_t from, size_t to) {
            this->take_in(
                std::span(batch.rays).subspan(from, to - from),
                std::span(batch.answers).subspan(from, to - from), [](auto&&...) { return true; },
                [](auto&&...) { return false; }); // there is no later leaf
        });
    }

private:
    void begin_part(Batch& batch) {
        const size_t part = s_.part_rays(query_.rays.size());
        const size_t first = next_, count = std::min(part, query_.rays.size() - first);
        const size_t blocks = (count + kGrain - 1) / kGrain;
        // A block writes its rays where it begins, then all move together: in order, and without
        // holes, whichever thread takes which block.
        batch.rays.resize(count);
        block_rays_.resize(blocks);
        parallel_for(blocks, 1, [&](size_t from, size_t to) {
            for (size_t b = from; b < to; ++b) {
                uint32_t* const rays = batch.rays.data() + b * kGrain;
                uint32_t n = 0;
                for (size_t i = b * kGrain; i < std::min((b + 1) * kGrain, count); ++i)
                    if (this->begins(uint32_t(first + i)))
                        rays[n++] = uint32_t(first + i);
                block_rays_[b] = n;
            }
        });
        size_t asked = 0;
        for (size_t b = 0; b < blocks; ++b) {
            const auto rays = batch.rays.begin() + ptrdiff_t(b * kGrain);
            std::copy(rays, rays + block_rays_[b], batch.rays.begin() + ptrdiff_t(asked));
            asked += block_rays_[b];
        }
        batch.rays.resize(asked);
        next_ += count;
        load(batch);
    }

    void load(Batch& batch) const {
        batch.make_room();
        parallel_for(batch.rays.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const uint32_t i = batch.rays[j];
                const Ray& ray = query_.rays[i];
                batch.travellers[j] = this->traveller(i, ray.t_min, ray.t_max, OVC_NO_LEAF);
            }
        });
    }

    size_t next_ = 0; // of the rays of the query
    std::vector<uint32_t> block_rays_;
};

} // namespace ovc
