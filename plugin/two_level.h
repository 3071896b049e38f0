// SPDX-License-Identifier: Apache-2.0
// Two-level: level 1, a page per leaf, passes in which rays walk from leaf to leaf as far as pages
// are in the pool, and wait for the others. Based on: thesis, sections 3.3 and 3.4 (algorithms 2, 3
// and 4), with level 1 walked in the kernel.
#pragma once

#include "core/log.h"
#include "gpu/gl_thread.h"
#include "gpu/tracer.h"
#include "plugin/build_scene.h"
#include "plugin/structure.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// Sums over the life of a structure, beside what the scene tells. Fields as in ovc_statistics.
struct TwoLevelStatistics {
    uint64_t passes = 0;
    uint64_t pages_in = 0;
    uint64_t bytes_in = 0;
    uint64_t nearest_rays = 0;
    uint64_t occlusion_rays = 0;
    uint64_t invalid_rays = 0;
    uint64_t ray_visits = 0;
    uint64_t flagged = 0;
    uint64_t retraced = 0;
    uint64_t capped = 0;
    uint64_t queues = 0; // of rays waiting for a leaf that was moved in
    uint64_t queued_rays = 0;
    uint64_t longest_queue = 0;
    uint64_t stragglers = 0; // answered in double, because too few waited to move a page for
    uint64_t peak_bytes = 0;
    double seconds_trace = 0;
    double seconds_kernel = 0;
    double seconds_pass = 0;
};

/// Level 1 and level 2 of a soup, and rays through them. One call at a time.
class TwoLevel final : public Structure {
public:
    /// The soup and the thread must outlive it. Error: a budget too small, with the smallest that
    /// works; GL's refusals.
    static Result<std::unique_ptr<TwoLevel>> build(const Soup& soup, GlThread& gl,
                                                   const TwoLevelOptions& options,
                                                   const LogSink& log,
                                                   BuildProgress* progress = nullptr);
    ~TwoLevel() override;

    Result<Done> intersect(RaySpan rays, std::span<const TriangleId> skip,
                           std::span<Hit> hits) override;
    Result<Done> occluded(RaySpan rays, std::span<const TriangleId> skip,
                          std::span<uint8_t> occluded) override;
    Result<Done> intersect_noted(RaySpan rays, std::span<const TriangleId> skip,
                                 std::span<Hit> hits, const RayNotes& notes) override;
    bool takes_notes() const override { return true; }
    bool has_cpu_tree() const override { return true; }
    Hit nearest_on_cpu(const Ray& ray, TriangleId skip) const override;
    bool occluded_on_cpu(const Ray& ray, TriangleId skip) const override;
    Result<Done> stream(StreamHost& host) override; // two_level_stream.cpp
    ovc_statistics report() const override;         // make_two_level.cpp
    Result<ovc_active> take_active() override;
    Result<Done> save(const ByteSink& sink) const override;
    Result<Done> purge() override;

    const TwoLevelStatistics& statistics() const { return statistics_; }
    const MemoryPlan& plan() const { return plan_; }
    const BuiltScene& scene() const { return scene_; }

private:
    TwoLevel(BuiltScene scene, GlThread& gl, const TwoLevelOptions& options, const MemoryPlan& plan,
             LogSink log)
        : scene_(std::move(scene)), gl_(gl), log_(std::move(log)), options_(options), plan_(plan) {}

    void share_out();
    void bring_first(BuildProgress* progress);
    Result<Done> make_tracer(BuildProgress* progress);
    Result<Done> ready_device();
    Error lost();
    /// Whether the context that the tracer lives in is there. On its thread.
    bool is_ours(const GlState& state) const {
        return state.generation == tracer_generation_ && state.context.alive();
    }
    size_t bring(std::span<const uint32_t> wanted);

    /// Fewer rays are not worth a pass while others wait.
    size_t few_rays() const { return std::min<size_t>(4096, plan_.batch_rays / 4); }

    /// So many rays of `rays` a pass keep a device busy, and leave something to do beside it. Where
    /// somebody may cancel the call, a pass takes some hundredths of a second, as far as the pass
    /// before tells.
    size_t part_rays(size_t rays) const {
        constexpr size_t kMin = size_t(1) << 15, kMax = size_t(1) << 17, kMinWatched = 1024;
        constexpr double kSeconds = 0.03;
        const size_t part = std::min<size_t>(std::clamp(rays / 4, kMin, kMax), plan_.batch_rays);
        if (!is_watched())
            return part;
        const double fitting = kSeconds / std::max(seconds_a_ray_, 1e-9);
        return std::min(part, std::max(kMinWatched, size_t(fitting)));
    }

    template <class Query>
    class Settling;
    template <class Query>
    class OnePass;
    template <class Query>
    class Wave;
    template <class Query>
    class Lane;
    class Stream;
    /// The leaves worth moving in for rays of these waves where few are ready; else none.
    template <class... Queries>
    std::vector<uint32_t> wanted_by(const Wave<Queries>&... waves) const;
    /// Rays of a pass, and what it answers.
    struct Batch {
        std::vector<uint32_t> rays;        // their numbers in the query
        std::array<size_t, 2> of_waves{};  // so many of each wave, one behind the other
        std::vector<Traveller> travellers; // as the next, at least one per ray, to a whole block
        std::vector<Answer> answers;

        void make_room() {
            const size_t room = std::max(whole_blocks(rays.size()), travellers.size());
            travellers.resize(room);
            answers.resize(room);
        }
    };
    template <class... Queries>
    void load(Batch& batch, size_t most, Wave<Queries>&... waves);
    template <class... Queries>
    void settle(const Batch& batch, Wave<Queries>&... waves);
    /// Passes of what is ready, of at most `most` rays of all these waves. Pages that others wait
    /// for are moved in before them where few rays are ready, and beside them where few are left.
    /// meanwhile() -> bool runs beside each pass; false: it is the last.
    template <class Meanwhile, class... Queries>
    Result<Done> round(size_t most, Meanwhile&& meanwhile, Wave<Queries>&... waves);
    Result<size_t> pass(Batch& batch, std::span<const uint32_t> wanted,
                        const std::function<void()>& meanwhile);
    template <bool kAnyHit>
    Hit on_cpu(const Ray& ray, TriangleId skip) const;
    template <class Query>
    Result<Done> trace(const Query& query);
    template <class Query>
    Result<Done> trace_in_waves(const Query& query);
    template <class Query>
    Result<Done> trace_in_one_pass(const Query& query);

    const BuiltScene scene_;
    GlThread& gl_;
    const LogSink log_;
    TwoLevelOptions options_;
    MemoryPlan plan_;
    std::vector<uint8_t> was_active_; // per leaf: when take_active() was asked last
    std::unique_ptr<Tracer> tracer_;  // made and destroyed on the thread of gl_; none after purge()
    uint32_t tracer_generation_ = 0;  // of the context that it was made in
    std::array<Batch, 2> batches_;    // kept between calls
    double seconds_a_ray_ = 1e-5;     // of the pass before
    TwoLevelStatistics statistics_;
};

} // namespace ovc
