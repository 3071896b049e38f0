// SPDX-License-Identifier: Apache-2.0
// Single rays: calls of one ray each from many threads at once, beside all else on the scene. They
// share no lock and no cache line.
#pragma once

#include "core/ray.h"
#include "plugin/structure.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

namespace ovc {

class SingleRays {
    struct Shard;

public:
    /// The structure that calls are answered by, from now on; calls that were made before this
    /// returns are over. nullptr: none.
    void serve(Structure* structure) {
        structure_ = structure;
        for (const Shard& shard : shards_)
            while (shard.inside != 0)
                std::this_thread::sleep_for(std::chrono::microseconds(100));
    }

    /// A call under way, while it lives.
    class Call {
    public:
        explicit Call(SingleRays& rays) : rays_(rays), shard_(rays.own_shard()) {
            ++shard_.inside; // then the structure is read; serve() does both the other way round
            structure_ = rays_.structure_;
        }
        ~Call() { --shard_.inside; }
        Call(const Call&) = delete;

        /// nullptr: there is none.
        Structure* structure() const { return structure_; }

        Hit nearest(const Ray& ray, TriangleId skip) {
            count(shard_.nearest, ray);
            return structure_->nearest_on_cpu(ray, skip);
        }
        bool occluded(const Ray& ray, TriangleId skip) {
            count(shard_.occlusion, ray);
            return structure_->occluded_on_cpu(ray, skip);
        }

    private:
        void count(std::atomic<uint64_t>& kind, const Ray& ray) {
            kind.fetch_add(1, std::memory_order_relaxed);
            if (!ray.valid())
                shard_.invalid.fetch_add(1, std::memory_order_relaxed);
        }

        SingleRays& rays_;
        Shard& shard_;
        Structure* structure_;
    };

    /// Adds what was counted.
    void add_to(ovc_statistics& statistics) const {
        for (const Shard& shard : shards_) {
            statistics.nearest_rays += shard.nearest;
            statistics.occlusion_rays += shard.occlusion;
            statistics.invalid_rays += shard.invalid;
            statistics.single_rays += shard.nearest + shard.occlusion;
        }
    }

private:
    /// What some of the threads write; each has one that is always the same.
    struct alignas(64) Shard {
        std::atomic<uint32_t> inside{0}; // calls under way
        std::atomic<uint64_t> nearest{0};
        std::atomic<uint64_t> occlusion{0};
        std::atomic<uint64_t> invalid{0};
    };

    Shard& own_shard() {
        const size_t hash = std::hash<std::thread::id>()(std::this_thread::get_id());
        return shards_[(hash * 0x9e3779b97f4a7c15u) >> 58];
    }

    std::atomic<Structure*> structure_{nullptr};
    std::array<Shard, 64> shards_;
};

} // namespace ovc
