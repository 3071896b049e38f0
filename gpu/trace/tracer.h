// SPDX-License-Identifier: Apache-2.0
// Tracer: runs passes of the kernel over rays on their way through the top-level tree and the
// resident pages, within a budget of GPU bytes.
#pragma once

#include "core/function_ref.h"
#include "core/result.h"
#include "gpu/budget/ledger.h"
#include "gpu/driver/driver_threads.h"
#include "gpu/gl/egl_context.h"
#include "gpu/gl/kernel.h"
#include "gpu/gl/workarounds.h"
#include "gpu/page/top_level.h"
#include "gpu/trace/answers.h"
#include "gpu/trace/pass_slot.h"
#include "gpu/trace/pool.h"
#include "gpu/trace/sent_rays.h"
#include "gpu/trace/uploads.h"
#include "gpu/tuning/kernel_variant.h"
#include "shaders/layout.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// The precision of all passes, and the variants of their kernels.
struct PassOptions {
    bool certify = true; // false: fast precision
    ChosenVariants variants;
    bool counts = false; // answers tell rounds and units in the place of further()
};

/// How a budget is shared out: pages get the bytes that rays, answers and portals leave.
struct MemoryPlan {
    uint64_t budget_bytes = 0;
    uint32_t batch_rays = 0; // max rays in a pass
    uint32_t passes = 1;     // that may be under way together, each with its rays and answers
    uint64_t pool_bytes = 0;
    uint64_t buffer_bytes = ~uint64_t(0); // max of one of the pool's buffers
    uint64_t active_bytes = 0; // 4 a leaf: passes mark the pages that rays are traced through; or 0
    uint64_t bytes_per_ray = sizeof(RayState) + kAnswerBytes;
    uint64_t driver_bytes = ~uint64_t(0); // for tests: the driver's memory

    /// How many more answers there is room for: rays that packets part (gpu/trace/packets.h).
    uint32_t parted_rays() const { return batch_rays / 64 / kBlockRays * kBlockRays; }
    PoolLayout pool() const { return {pool_bytes, buffer_bytes}; }
    uint64_t ray_bytes() const {
        return passes * (batch_rays * bytes_per_ray + parted_rays() * kAnswerBytes + kCounterBytes);
    }
};

/// Returns the plan for a budget, clamped to the device; the bytes of portals are not yet taken
/// off. bytes_per_ray: of a ray and its answer. buffer_bytes: max of one of the pool's buffers; 0:
/// as much as the device can. Error: a budget below the needs of the smallest page and batch, with
/// their number of bytes.
Result<MemoryPlan> plan_memory(uint64_t budget_bytes, const DeviceInfo& device,
                               uint64_t bytes_per_ray = sizeof(RayState) + kAnswerBytes,
                               uint64_t buffer_bytes = 0);

/// Pages moved to the GPU.
struct Moved {
    uint64_t pages = 0;
    uint64_t bytes = 0;
};

/// Traces rays on the device. All calls need the context current.
class Tracer {
public:
    ~Tracer();

    /// Returns a tracer with nothing resident but the tree. pages lie in `bounds`, and top is the
    /// tree over them, for which is_usable() in the plan's pool; pages, top and kernels outlive the
    /// tracer. Error of the kind OutOfGpuMemory: the driver refused the plan's bytes; a smaller
    /// pool may do.
    static Result<std::unique_ptr<Tracer>> create(const MemoryPlan& plan,
                                                  const PassOptions& options,
                                                  const DeviceInfo& device, KernelCache& kernels,
                                                  const Box& bounds, std::span<const Page> pages,
                                                  const TopLevel& top);

    /// Moves in the pages of `wanted`, leaves that are not resident, in this order: as many as fit
    /// without evicting each other, at least the first.
    Moved bring(std::span<const uint32_t> wanted);
    /// Calls take(units of the page) while these are in memory; not at all where they cannot be.
    using GivePage =
        FunctionRef<void(uint32_t leaf, FunctionRef<void(std::span<const uvec4>)> take)>;
    /// The same for pages that need not be in memory; ends at one that is not given.
    Moved bring(std::span<const uint32_t> wanted, const GivePage& give);

    /// Takes up the pages and the top-level tree as they are now, in `bounds`; the others that were
    /// given to create() live on. was: for each page its number before, or kNone; changed: those
    /// whose units are others than before. Resident pages are patched in place; where one has
    /// another size it goes, and is to be brought again. Returns false, with the tracer of no use,
    /// where there is no room for the tree or its tables.
    bool update(const Box& bounds, std::span<const Page> pages, std::span<const uint32_t> was,
                std::span<const uint32_t> changed);

    /// Returns the pages that are not resident.
    std::vector<uint32_t> missing() const;
    /// Whether the pool has room for all pages.
    bool all_fit() const { return all_fit_; }

    /// Whether all pages are in the pool, so that a pass answers its rays for good.
    bool all_resident() const {
        return all_fit_ && pool_.residency().resident_count() == page_data_.size();
    }

    /// How submit() wants its rays, until the next update(). At any time.
    RayForm form() const;
    /// A pass under way: the number of its slot.
    using Pass = size_t;
    /// Sends the rays (at least one, at most plan.batch_rays) on their way through the pages that
    /// are resident now, behind the passes that are under way, fewer than plan.passes. An answer is
    /// for all pages on the way up to the one that it names, for which the ray waits, or for all
    /// pages. Pages moved in after this call serve the next pass; they may be uploaded while this
    /// one runs. If all rays ask whether anything is hit, answers do not tell which triangle is.
    /// The rays, of which some may be moved, live until collect().
    Result<Pass> submit(SentRays& rays);
    /// Takes these variants from now on.
    void use(const ChosenVariants& variants) { options_.variants = variants; }
    /// The kind of the rays whose answers were collected last.
    RayKind ray_kind() const { return kind_; }

    /// Whether the device can read the scene in the variant's way. A kernel that reads it all the
    /// same may answer wrongly.
    bool can_read_as(const KernelVariant& variant) const;
    /// Whether the device and the scene suit the variant.
    bool can_run(const KernelVariant& variant) const;
    /// Begins to compile the kernel for rays of that kind as another variant; is_ready() tells
    /// whether that is over.
    void begin_to_compile(const KernelVariant& variant);
    bool is_ready(const KernelVariant& variant) const;

    /// Waits for the answers of the pass, which is over then.
    Result<Done> collect(Pass pass, Answers& answers);
    /// Submits the rays, and waits for their answers.
    Result<Done> trace(SentRays& rays, Answers& answers);
    /// Whether passes were submitted that are not collected.
    bool are_passes_under_way() const;

    /// The seconds that the kernel took in the pass that was collected last, without the transfer
    /// of rays and answers: by the device's clock, or for a software renderer by DriverThreads.
    double kernel_seconds() const { return kernel_seconds_; }

    /// Returns for each leaf whether rays were traced through its page since the last call (not 0),
    /// and clears that; empty if the plan has no active_bytes.
    std::vector<uint32_t> take_active();

    const Ledger& ledger() const { return *ledger_; }

private:
    Tracer(std::unique_ptr<Ledger> ledger, const MemoryPlan& plan, const PassOptions& options,
           const DeviceInfo& device, KernelCache& kernels, const Box& bounds,
           std::span<const Page> pages, const TopLevel& top);

    bool resident(uint32_t leaf) const { return pool_.residency().resident(leaf); }
    Result<Done> set_up();
    bool has_portals() const { return !top_.portals.empty(); }
    /// Whether rays of the pass may have to wait for a page.
    bool may_wait() const { return !all_fit_; }
    bool takes_float_pairs() const;
    ShaderConfig shader_config(RayKind kind, const KernelVariant& variant) const;
    bool claims(const KernelVariant& variant) const;
    static bool packs(RayKind kind, const KernelVariant& variant) {
        return variant.packets && kind.coherent && !kind.has_portals();
    }
    uint32_t stack_words(const KernelVariant& variant) const;
    StackPlace stack_place(const KernelVariant& variant, uint32_t words) const;
    void begin_to_compile_both(RayKind kind, const ShaderConfig& config);
    void show_rays(PassSlot& slot);
    Result<Done> launch(PassSlot& slot);
    Result<Done> collect(PassSlot& slot, Answers& answers);
    void read(PassSlot& slot, Answers& answers);
    static void read_lists(const PassSlot& slot, Answers& answers);
    static bool lost_many(const Answers& answers, size_t rays);
    bool go_on_longer(const PassSlot& slot);
    void say_where(uint32_t leaf);
    void upload_top_level();
    uint32_t way_to(uint32_t leaf, const Link& link) const;

    const uint32_t generation_ = gl::context_generation;
    std::unique_ptr<Ledger> ledger_; // the objects below keep its address
    KernelCache& kernels_;
    PassOptions options_;
    std::span<const Page> page_data_;
    const DeviceInfo device_;
    RayKind kind_;                                  // of the pass that was collected last
    uint32_t min_stack_words_ = 0;                  // fewer lost too many rays
    bool gives_rays_all_rounds_ = false;            // rays need all rounds that there are
    mutable std::optional<bool> keeps_float_pairs_; // the driver; asked when somebody wants to know
    const bool counts_rounds_ = needs(Workaround::CountedRounds);
    const bool registers_lose_words_ = needs(Workaround::ShortRegisterStack);
    const TopLevel& top_;
    bool all_fit_;         // the pool has room for all pages and the tree
    Leaf scene_;           // the whole scene as one leaf: the top-level tree's frame
    uint32_t stack_depth_; // words with which no ray is lost
    Uploads uploads_;
    std::vector<PassSlot> slots_;
    std::optional<gl::Buffer> portal_buffer_;
    gl::BufferTexture portals_;
    std::optional<gl::Buffer> active_buffer_;
    gl::BufferTexture active_;
    Pool pool_;
    DriverThreads driver_threads_ = DriverThreads::find();
    double kernel_seconds_ = 0;
};

} // namespace ovc
