// SPDX-License-Identifier: Apache-2.0
// SingleRays: answers calls of one ray each, and small batches, from many threads at once, beside
// all other calls on the scene. Each thread walks the CPU's tree, or single rays are gathered for
// the GPU, whichever is faster.
#pragma once

#include "core/system/turn.h"
#include "plugin/structure/faster_way.h"
#include "plugin/structure/gathering.h"
#include "plugin/structure/in_stream.h"
#include "plugin/structure/joined_rays.h"
#include "plugin/structure/structure.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace ovc {

/// One ray, and its answer.
struct SingleRay {
    bool any_hit = false;
    Ray ray;
    Exclusion without;
    RaySieve sieve;
    Hit hit{};             // the answer unless any_hit
    bool occluded = false; // the answer if any_hit
};

class SingleRays {
    struct Shard;

public:
    /// turn: the scene's, which outlives this.
    explicit SingleRays(Turn& turn) : turn_(turn) {}

    /// Sets the structure that answers calls from now on; nullptr: none. When this returns, no call
    /// uses the structure before it any more.
    void serve(Structure* structure) {
        structure_ = structure;
        for (const Shard& shard : shards_)
            while (shard.inside != 0)
                std::this_thread::sleep_for(std::chrono::microseconds(100));
    }

    /// Forgets what was counted. No call is under way.
    void count_anew() {
        for (Shard& shard : shards_)
            for (std::atomic<uint64_t>* count :
                 {&shard.nearest, &shard.occlusion, &shard.nearest_in_batches,
                  &shard.occlusion_in_batches, &shard.invalid, &shard.gathered})
                *count = 0;
    }

    /// One call. serve() waits until it is destroyed.
    class Call {
    public:
        explicit Call(SingleRays& rays) : rays_(rays), shard_(rays.own_shard()) {
            ++shard_.inside; // then the structure is read; serve() does both the other way round
            structure_ = rays_.structure_;
        }
        ~Call() { --shard_.inside; }
        Call(const Call&) = delete;

        /// Returns nullptr where there is none.
        Structure* structure() const { return structure_; }

        /// Answers a ray; an invalid one misses. Needs a structure that has_cpu_tree().
        void answer(SingleRay& asked) {
            assert(structure_ && structure_->has_cpu_tree());
            if (!asked.sieve.passes_all()) {
                answer_on_cpu(asked);
                return;
            }
            const FasterWay::Use use = rays_.way_.begin();
            const uint64_t before = use.way == kGathered && rays_.gather(*structure_, asked)
                                        ? add_one(shard_.gathered)
                                        : answer_on_cpu(asked);
            rays_.way_.end(use, /* may_look= */ before % 64 == 0);
        }

        /// Answers a batch where that is sooner than in the scene's turn; else returns false.
        bool nearest(RaySpan rays, const Exclusions& without, std::span<Hit> hits) {
            uint64_t invalid = 0;
            const bool done = structure_ && structure_->intersect_few(rays, without, hits, invalid);
            if (done)
                count_batch(shard_.nearest_in_batches, rays.size(), invalid);
            return done;
        }
        bool occluded(RaySpan rays, const Exclusions& without, std::span<uint8_t> occluded) {
            uint64_t invalid = 0;
            const bool done =
                structure_ && structure_->occluded_few(rays, without, occluded, invalid);
            if (done)
                count_batch(shard_.occlusion_in_batches, rays.size(), invalid);
            return done;
        }

    private:
        void count_batch(std::atomic<uint64_t>& rays, uint64_t count, uint64_t invalid) {
            rays += count;
            shard_.invalid += invalid;
        }

        uint64_t answer_on_cpu(SingleRay& asked) {
            if (!asked.ray.valid())
                add_one(shard_.invalid);
            else if (asked.any_hit)
                asked.occluded = structure_->occluded_on_cpu(asked.ray, asked.without, asked.sieve);
            else
                asked.hit = structure_->nearest_on_cpu(asked.ray, asked.without, asked.sieve);
            return add_one(asked.any_hit ? shard_.occlusion : shard_.nearest);
        }

        /// Returns the count before the addition.
        static uint64_t add_one(std::atomic<uint64_t>& count) {
            return count.fetch_add(1, std::memory_order_relaxed);
        }

        SingleRays& rays_;
        Shard& shard_;
        Structure* structure_;
    };

    /// Adds what was counted; the structure has counted what was gathered. Calls may be under way:
    /// each counter is read once, so that the sums agree.
    void add_to(ovc_statistics& statistics) const {
        for (const Shard& shard : shards_) {
            const uint64_t nearest = shard.nearest, occlusion = shard.occlusion;
            const uint64_t gathered = shard.gathered;
            statistics.nearest_rays += nearest + shard.nearest_in_batches;
            statistics.occlusion_rays += occlusion + shard.occlusion_in_batches;
            statistics.invalid_rays += shard.invalid;
            statistics.single_rays += nearest + occlusion + gathered;
            statistics.gathered_rays += gathered;
        }
    }

private:
    enum { kOnCpu = 0, kGathered = 1 }; // the ways

    /// The counters that some of the threads write. A thread always uses the same shard.
    struct alignas(64) Shard {
        std::atomic<uint32_t> inside{0};  // calls under way
        std::atomic<uint64_t> nearest{0}; // single rays that the CPU answered
        std::atomic<uint64_t> occlusion{0};
        std::atomic<uint64_t> nearest_in_batches{0}; // which the CPU answered, too
        std::atomic<uint64_t> occlusion_in_batches{0};
        std::atomic<uint64_t> invalid{0}; // of all these
        std::atomic<uint64_t> gathered{0};
    };

    Shard& own_shard() {
        const size_t hash = std::hash<std::thread::id>()(std::this_thread::get_id());
        return shards_[(hash * 0x9e3779b97f4a7c15u) >> 58];
    }

    /// Returns false where another call has the turn or the batch cannot be traced. Never waits for
    /// a call of another kind.
    bool gather(Structure& structure, SingleRay& asked) {
        if (in_stream)
            return false;
        return gathering_.answer(asked, [&](std::span<SingleRay* const> batch) {
            const std::unique_lock turn(turn_, std::try_to_lock);
            return turn.owns_lock() && trace(structure, batch, /* any_hit= */ false) &&
                   trace(structure, batch, /* any_hit= */ true);
        });
    }

    /// Traces the rays of the batch that ask for any hit, or those that ask for the nearest.
    static bool trace(Structure& structure, std::span<SingleRay* const> batch, bool any_hit) {
        std::vector<SingleRay*> asked;
        for (SingleRay* single : batch)
            if (single->any_hit == any_hit)
                asked.push_back(single);
        if (asked.empty())
            return true;
        JoinedRays joined(asked.size());
        for (size_t i = 0; i < asked.size(); ++i)
            joined.set(i, asked[i]->ray, asked[i]->without);
        std::vector<Hit> hits(any_hit ? 0 : asked.size());
        std::vector<uint8_t> occluded(any_hit ? asked.size() : 0);
        if (!(any_hit ? structure.occluded(joined.rays(), joined.without(), occluded)
                      : structure.intersect(joined.rays(), joined.without(), hits)))
            return false;
        for (size_t i = 0; i < asked.size(); ++i)
            if (any_hit)
                asked[i]->occluded = occluded[i] != 0;
            else
                asked[i]->hit = hits[i];
        return true;
    }

    Turn& turn_;
    std::atomic<Structure*> structure_{nullptr};
    FasterWay way_;
    Gathering<SingleRay> gathering_;
    std::array<Shard, 64> shards_;
};

} // namespace ovc
