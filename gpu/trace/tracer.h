// SPDX-License-Identifier: Apache-2.0
// Tracer: passes of the kernel over rays on their way through the top-level tree and the resident
// pages, within a budget of GPU bytes.
#pragma once

#include "core/result.h"
#include "gpu/gl/driver_threads.h"
#include "gpu/gl/egl_context.h"
#include "gpu/gl/kernel.h"
#include "gpu/gl/ledger.h"
#include "gpu/gl/workarounds.h"
#include "gpu/page/top_level.h"
#include "gpu/trace/answers.h"
#include "gpu/trace/packets.h"
#include "gpu/trace/pool.h"
#include "shaders/layout.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// A ray on its way, in the layout of shaders/layout.h. In the world's coordinates: finite, of a
/// direction whose reciprocals are finite, as can_walk() of kdtree/restart.h asks.
struct RayState {
    Ray ray{dvec3(0), 0, dvec3(0, 0, 1), -1}; // t_max < t_min: no ray
    std::array<uint32_t, 2> zeros{};
    uint32_t skip = OVC_NO_TRIANGLE; // number of a triangle it does not see
    uint32_t asks = 0; // the resume key, or 0; with OVC_RAY_ANY_HIT added: any hit will do

    bool any_hit() const { return (asks & OVC_RAY_ANY_HIT) != 0; }
    uint32_t key() const { return asks & ~OVC_RAY_ANY_HIT; }
};
static_assert(sizeof(RayState) == OVC_RAY_TEXELS * sizeof(uvec4));

/// How passes are made.
struct PassOptions {
    bool certify = true;  // false: fast precision
    bool compute = false; // which kernel: they answer alike
};

/// How a budget is shared out: pages get what rays, answers and portals leave.
struct MemoryPlan {
    uint64_t budget_bytes = 0;
    uint32_t batch_rays = 0; // most rays a pass
    uint64_t pool_bytes = 0;
    uint64_t buffer_bytes = ~uint64_t(0); // the most of one of the pool's buffers
    uint64_t active_bytes = 0; // 4 a leaf, or 0: passes mark which pages rays are traced through
    uint64_t bytes_per_ray = sizeof(RayState) + kAnswerBytes;
    uint64_t driver_bytes = ~uint64_t(0); // for tests: what the driver has

    /// For how many rays besides there are answers: those that packets part (gpu/trace/packets.h).
    uint32_t parted_rays() const { return batch_rays / 64 / kBlockRays * kBlockRays; }
    PoolLayout pool() const { return {pool_bytes, buffer_bytes}; }
    uint64_t ray_bytes() const { return batch_rays * bytes_per_ray + parted_rays() * kAnswerBytes; }
};

/// The plan for a budget, clamped to the device, portals not yet taken off. Error: a budget below
/// what the smallest page and batch need, with the number.
/// bytes_per_ray: of a ray and its answer. buffer_bytes: at most, of one of the pool's buffers; 0:
/// as much as the device can.
Result<MemoryPlan> plan_memory(uint64_t budget_bytes, const DeviceInfo& device,
                               uint64_t bytes_per_ray = sizeof(RayState) + kAnswerBytes,
                               uint64_t buffer_bytes = 0);

/// Pages moved to the GPU.
struct Moved {
    uint64_t pages = 0;
    uint64_t bytes = 0;
};

/// All calls need the context current.
class Tracer {
public:
    /// Error of the kind OutOfGpuMemory: the driver refused the plan's bytes; a smaller pool may
    /// do. kernels outlives the tracer. pages lie in `bounds`, and top is the tree over them; both
    /// outlive the tracer. is_usable() in the plan's pool.
    static Result<std::unique_ptr<Tracer>> create(const MemoryPlan& plan,
                                                  const PassOptions& options,
                                                  const DeviceInfo& device, KernelCache& kernels,
                                                  const Box& bounds, std::span<const Page> pages,
                                                  const TopLevel& top);

    /// Moves in the pages of `wanted`, leaves that are not resident, in this order, as many as fit
    /// without pushing each other out: the first at least.
    Moved bring(std::span<const uint32_t> wanted);

    /// All pages are in the pool, so that a pass answers its rays for good.
    bool all_resident() const { return all_fit_ && pages_moved_ == page_data_.size(); }

    /// Sends the rays (at most plan.batch_rays) on their way through the pages that are resident
    /// now. An answer is that of all pages on the way to the one it names, which the ray waits for,
    /// or of all. Pages moved in from here on serve the next pass, and may go over while this one
    /// runs.
    /// Where all rays ask whether anything is hit, an answer does not tell which triangle is.
    Result<Done> submit(std::span<const RayState> rays);

    /// Waits for the answers of the pass that was submitted, as many as its rays. The storage of
    /// rays is used up to the next whole block: see whole_blocks().
    Result<Done> collect(std::span<Answer> answers);

    /// How long the kernel took in the pass that was collected last, without rays going over and
    /// answers coming back: the device's clock; with a software renderer gpu/gl/driver_threads.h.
    double kernel_seconds() const { return kernel_seconds_; }

    /// Per leaf, whether rays were traced through its page since this was asked last; none where
    /// the plan has no active_bytes.
    std::vector<uint32_t> take_active();

    const Ledger& ledger() const { return *ledger_; }

private:
    Tracer(std::unique_ptr<Ledger> ledger, const MemoryPlan& plan, const PassOptions& options,
           const DeviceInfo& device, KernelCache& kernels, const Box& bounds,
           std::span<const Page> pages, const TopLevel& top);

    bool resident(uint32_t leaf) const { return pool_.residency().resident(leaf); }
    Result<Done> set_up();
    bool has_portals() const { return !top_.portals.empty(); }
    bool takes_packets() const { return software_ && options_.compute && !has_portals(); }
    /// Whether rays of the pass may have to wait for a page.
    bool may_wait() const { return !all_fit_; }
    void upload(std::span<const RayState> rays);
    void upload_world(std::span<const RayState> rays);
    void come_back(std::span<Answer> answers) const;
    ShaderConfig shader_config() const;
    Result<Done> launch();
    void read(std::span<Answer> answers);
    static bool lost_many(std::span<const Answer> answers);
    bool go_on_longer();
    void say_where(uint32_t leaf);
    template <class Sent>
    void upload_local(std::span<const RayState> rays, std::vector<Sent>& sent);

    std::unique_ptr<Ledger> ledger_; // the objects below keep its address
    KernelCache& kernels_;
    PassOptions options_;
    std::span<const Page> page_data_;
    bool software_;
    bool refills_ = false; // lanes go on to a next ray
    const bool counts_rounds_ = needs(Workaround::CountedRounds);
    const bool registers_lose_words_ = needs(Workaround::ShortRegisterStack);
    const bool finishes_passes_ = needs(Workaround::FinishedPass);
    const TopLevel& top_;
    bool all_fit_;                    // the pool has room for all pages and the tree
    uint64_t pages_moved_ = 0;        // into the pool, all in all
    Leaf scene_;                      // as one leaf: the frame of the top-level tree
    std::vector<LocalRay> local_;     // of the pass, where all pages fit
    std::vector<ResumedRay> resumed_; // where they do not
    std::vector<LocalTime> times_;    // of them, in fast precision
    uint32_t stack_depth_;            // with which no ray is lost
    uint32_t stack_words_;            // of the kernel
    uint32_t max_slots_;              // of a pass
    bool any_hit_ = false;            // all rays of the pass ask whether anything is hit
    size_t rays_sent_ = 0;            // of the pass
    size_t slots_sent_ = 0;           // and with those that were parted
    bool packets_ = false;            // they are taken two at a time
    std::vector<Parted> parted_;
    std::vector<Answer> parted_answers_;
    gl::Buffer ray_buffer_;
    gl::BufferTexture rays_;
    std::optional<AnswerPixels> pixels_; // of the fragment kernel
    std::optional<AnswerWords> words_;   // of the compute kernel
    std::optional<gl::Buffer> portal_buffer_;
    gl::BufferTexture portals_;
    std::optional<gl::Buffer> active_buffer_;
    gl::BufferTexture active_;
    Pool pool_;
    gl::TimeQuery time_;
    DriverThreads driver_threads_ = DriverThreads::find();
    double kernel_seconds_ = 0;
};

} // namespace ovc
