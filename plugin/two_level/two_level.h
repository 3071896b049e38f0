// SPDX-License-Identifier: Apache-2.0
// TwoLevel: the structure of level 1 and a page per leaf. In a pass, rays go from page to page as
// far as these are in the pool, and wait for the others. Based on: thesis, sections 3.3 and 3.4
// (algorithms 2, 3 and 4), but the kernel finds the way from page to page.
#pragma once

#include "core/system/log.h"
#include "plugin/leaf_store/leaf_store.h"
#include "plugin/resolve/query.h"
#include "plugin/structure/structure.h"
#include "plugin/two_level/pass_runner.h"

#include <atomic>
#include <memory>
#include <span>
#include <vector>

namespace ovc {

/// Owns a scene and its part on the device, and traces rays through it. One call at a time.
class TwoLevel final : public Structure {
public:
    /// Builds or restores the scene, and opens it on the device. The soup and the thread must
    /// outlive it. Error: the budget is too small, with the smallest that works, or GL refuses
    /// something. Throws Cancelled when `progress` is told to stop.
    static Result<std::unique_ptr<TwoLevel>> build(const Soup& soup, GlThread& gl,
                                                   const TwoLevelOptions& options,
                                                   const LogSink& log,
                                                   BuildProgress* progress = nullptr);

    Result<Done> intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) override;
    Result<Done> occluded(RaySpan rays, const Exclusions& without,
                          std::span<uint8_t> occluded) override;
    Result<Done> intersect_noted(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                                 const RayNotes& notes) override;
    bool takes_notes() const override { return true; }
    bool takes_after() const override { return true; }
    /// A single ray would have no way to say that a page cannot be read.
    bool has_cpu_tree() const override { return !scene_.store; }
    Result<Done> all_hits(RaySpan rays, const Exclusions& without, const AllHits& all) override;
    Hit nearest_on_cpu(const Ray& ray, const Exclusion& without,
                       const RaySieve& sieve) const override;
    bool occluded_on_cpu(const Ray& ray, const Exclusion& without,
                         const RaySieve& sieve) const override;
    bool intersect_few(RaySpan rays, const Exclusions& without, std::span<Hit> hits,
                       uint64_t& invalid) const override;
    bool occluded_few(RaySpan rays, const Exclusions& without, std::span<uint8_t> occluded,
                      uint64_t& invalid) const override;
    Result<Done> stream(StreamHost& host) override;
    ovc_statistics report() const override; // make_two_level.cpp
    Result<ovc_active> take_active() override;
    Result<Done> save(const ByteSink& sink) const override;
    Result<bool> update(const Changes& changes, BuildProgress* progress) override;
    Result<Done> purge() override;

    const BuiltScene& scene() const { return scene_; }
    const ovc_statistics& statistics() const { return statistics_; }
    const MemoryPlan& plan() const { return passes_.plan(); }

private:
    TwoLevel(BuiltScene scene, GlThread& gl, const TwoLevelOptions& options, const MemoryPlan& plan,
             const LogSink& log)
        : scene_(std::move(scene)),
          options_(options),
          plan_(plan),
          passes_(tracing_, gl, plan, log) {
        if (scene_.store)
            scene_.store->on_failure([this](Error error) { watch_.fail(std::move(error)); });
    }

    template <class Query>
    Result<Done> trace(const Query& query);
    Result<Done> trace_nearest(NearestQuery query);
    template <class Query>
    bool answer_few(const Query& query, uint64_t& invalid) const;
    /// Answers at most kMaxFewRays rays. Returns how many are invalid.
    template <class Query>
    uint64_t answer_group(const Query& query) const;
    /// Calls trace() and counts it as a call with so many rays.
    template <class Trace>
    Result<Done> counted(uint64_t& rays_of_a_kind, size_t rays, Trace&& trace);

    BuiltScene scene_;
    const TwoLevelOptions options_;
    const MemoryPlan plan_; // for any scene; passes_ has that for this one
    ovc_statistics statistics_{sizeof(ovc_statistics)};
    const Tracing tracing_{scene_, options_, statistics_, watch_};
    PassRunner passes_;
    /// Whether the last call found all pages in the pool. Where it did not, answers on the CPU
    /// would make it a matter of time which pages come and go.
    std::atomic<bool> was_all_resident_{false};
    std::vector<uint8_t> was_active_; // per leaf, at the last take_active()
};

} // namespace ovc
