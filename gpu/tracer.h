// SPDX-License-Identifier: Apache-2.0
// Tracer: passes of the kernel over one leaf's rays, within a budget of GPU bytes.
#pragma once

#include "core/result.h"
#include "gpu/egl_context.h"
#include "gpu/kernel.h"
#include "gpu/ledger.h"
#include "gpu/pool.h"

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

namespace ovc {

/// A ray in a leaf's frame, in the layout of shaders/layout.h. Begins at t = 0.
struct LocalRay {
    vec3 org;
    float t_end; // negative: no ray
    vec3 dir;    // largest component 1 or -1
    uint32_t skip;
};
static_assert(sizeof(LocalRay) == 32);

/// What the kernel answers, in the layout of shaders/layout.h. prim is the index of a triangle of
/// the leaf, OVC_MISS or OVC_FLAGGED.
struct LocalAnswer {
    std::array<uint32_t, 3> words;
    uint32_t prim;

    /// Certified: triangles that may be the answer as well, or OVC_NO_TRIANGLE.
    std::span<const uint32_t, 2> rivals() const { return std::span(words).first<2>(); }
    /// Fast precision.
    float t() const { return std::bit_cast<float>(words[0]); }
    float u() const { return std::bit_cast<float>(words[1]); }
    float v() const { return std::bit_cast<float>(words[2]); }
};
static_assert(sizeof(LocalAnswer) == 16);

/// What a pass is to find, and how.
struct PassOptions {
    bool any_hit = false;
    bool certify = true;  // false: fast precision
    bool compute = false; // which kernel: they answer alike
};

/// How a budget is shared out: pages get what rays and answers leave.
struct MemoryPlan {
    uint64_t budget_bytes = 0;
    uint32_t batch_rays = 0; // most rays a pass
    uint64_t pool_bytes = 0;

    uint64_t ray_bytes() const {
        return uint64_t(batch_rays) * (sizeof(LocalRay) + sizeof(LocalAnswer));
    }
};

/// The plan for a budget, clamped to the device. Error: a budget below what the smallest page and
/// batch need, with the number.
Result<MemoryPlan> plan_memory(uint64_t budget_bytes, const DeviceInfo& device);

struct PassResult {
    uint64_t bytes_in = 0; // 0: the page was resident
    double seconds = 0;    // from the first command until the answers are here
};

/// All calls need the context current.
class Tracer {
public:
    /// kernels outlives the tracer. leaves: how many there are to name pages by.
    static Result<std::unique_ptr<Tracer>> create(const MemoryPlan& plan, const DeviceInfo& device,
                                                  KernelCache& kernels, size_t leaves);

    bool resident(uint32_t leaf) const { return pool_.resident(leaf); }

    /// Traces rays (at most plan.batch_rays) in the leaf's page, moving the page in if need be.
    /// answers: as many as rays. The storage of `rays` is used up to the next multiple of kRowRays:
    /// see row_padded().
    Result<PassResult> pass(uint32_t leaf, const Page& page, const PassOptions& options,
                            std::span<const LocalRay> rays, std::span<LocalAnswer> answers);

    const Ledger& ledger() const { return *ledger_; }

    static constexpr uint32_t kRowRays = 1024; // rays a texture row
    /// The size that buffers for n rays or answers must have: whole rows.
    static size_t row_padded(size_t n) { return (n + kRowRays - 1) / kRowRays * kRowRays; }

private:
    Tracer(std::unique_ptr<Ledger> ledger, const MemoryPlan& plan, const DeviceInfo& device,
           KernelCache& kernels, size_t leaves);

    std::unique_ptr<Ledger> ledger_; // the objects below keep its address
    KernelCache& kernels_;
    bool software_;
    gl::Texture2D rays_;
    gl::Texture2D answers_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray vertex_array_;
    Pool pool_;
    gl::BufferTexture page_;
};

} // namespace ovc
