// SPDX-License-Identifier: Apache-2.0
// LeafPasses: keeps the pool of pages, and runs passes of the kernel over the queue of one leaf,
// within a budget of GPU bytes.
#pragma once

#include "core/result.h"
#include "gpu/budget/ledger.h"
#include "gpu/gl/egl_context.h"
#include "gpu/trace/pool.h"
#include "gpu/trace/tracer.h"
#include "plugin/thesis/frame_ray.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ovc::thesis {

struct LeafPass {
    uint64_t bytes_in = 0; // 0: the page was resident
    double seconds = 0;    // from the first command until the answers are here
};

/// All calls need the context current.
class LeafPasses {
public:
    /// Returns the plan for a budget. Passes go one by one.
    static Result<ovc::MemoryPlan> plan_memory(uint64_t budget_bytes, DeviceInfo device) {
        device.passes_in_flight = 1;
        return ovc::plan_memory(budget_bytes, device, kBytesPerRay);
    }
    /// `pages` must outlive the passes. plan: as plan_memory() made it, and its pool holds the
    /// largest page. certify = false: fast precision. Error: GL refuses a texture or a buffer.
    static Result<std::unique_ptr<LeafPasses>> create(const ovc::MemoryPlan& plan,
                                                      const DeviceInfo& device,
                                                      std::span<const Page> pages, bool certify);

    bool resident(uint32_t leaf) const { return pool_.residency().resident(leaf); }

    /// Traces rays in the leaf's frame (at most plan.batch_rays) through its page, which is moved
    /// in if it is not resident. Rays from first_occlusion on are occlusion rays. Both spans are
    /// whole rows of the same size: see row_padded().
    Result<LeafPass> run(uint32_t leaf, std::span<const FrameRay> rays, size_t first_occlusion,
                         std::span<FrameAnswer> answers);

    const Ledger& ledger() const { return *ledger_; }

    static constexpr uint32_t kRowRays = OVC_QUEUE_ROW_RAYS;
    static_assert(kBlockRays % kRowRays == 0); // as plan_memory() counts them
    static size_t row_padded(size_t n) { return (n + kRowRays - 1) / kRowRays * kRowRays; }
    static constexpr uint64_t kBytesPerRay = sizeof(FrameRay) + sizeof(FrameAnswer);

private:
    LeafPasses(std::unique_ptr<Ledger> ledger, const ovc::MemoryPlan& plan,
               const DeviceInfo& device, std::span<const Page> pages, bool certify);
    Result<GLuint> kernel();
    uint64_t bring(uint32_t leaf);

    std::unique_ptr<Ledger> ledger_; // the objects below keep its address
    std::span<const Page> pages_;
    bool software_;
    bool certify_;
    gl::Texture2D rays_;
    gl::Texture2D answers_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray vertex_array_;
    const Uploads uploads_{/* behind_passes= */ false, 0};
    Pool pool_;
    std::optional<gl::Program> kernel_;
};

} // namespace ovc::thesis
