// SPDX-License-Identifier: Apache-2.0
// Runner: keeps a system's texels and kernel on the GPU, and traces batches of rays through them.
#pragma once

#include "core/result.h"
#include "gpu/budget/ledger.h"
#include "gpu/gl/egl_context.h"
#include "plugin/thesis/bounded_passes.h"
#include "plugin/thesis/frame_ray.h"
#include "plugin/thesis/tiles.h"

#include <array>
#include <memory>
#include <optional>
#include <span>

namespace ovc::thesis {

struct RunnerOptions {
    ovc_structure structure = OVC_STRUCTURE_SINGLE_TEXTURE;
    uint64_t budget_bytes = 0;
    uint32_t textures = 1; // at least; more than one for multi-texture only
    bool certify = true;
};

/// How a budget is used: the GPU holds the whole scene, and the rest is for rays.
struct MemoryPlan {
    TilePlan tiles;
    uint32_t rows = 0; // of kRowRays rays each

    uint32_t batch_rays() const;
};

/// Returns how `texels` (> 0) and rays share the budget. Error: budget or textures are too small;
/// it tells the scene's bytes, after at_least, and the limit.
Result<MemoryPlan> plan_memory(const RunnerOptions& options, uint64_t texels,
                               const char* at_least = "");

/// All calls need the context current.
class Runner {
public:
    static Result<std::unique_ptr<Runner>>
    create(const RunnerOptions& options, const MemoryPlan& plan, System system, bool software);

    /// Traces a batch of at most the plan's rays. Both spans are whole rows of the same size: see
    /// row_padded(). Returns how many passes that took.
    Result<uint64_t> trace(bool any_hit, std::span<const FrameRay> rays,
                           std::span<FrameAnswer> answers);

    const Ledger& ledger() const { return *ledger_; }

    static constexpr uint32_t kRowRays = 1024; // rays per texture row
    static size_t row_padded(size_t n) { return (n + kRowRays - 1) / kRowRays * kRowRays; }

private:
    Runner(std::unique_ptr<Ledger> ledger, const RunnerOptions& options, const MemoryPlan& plan,
           System system, bool software);
    Result<GLuint> link(std::optional<gl::Program>& program, const char* fragment, bool any_hit);

    std::unique_ptr<Ledger> ledger_; // the objects below keep its address
    RunnerOptions options_;
    bool software_;
    uint32_t stack_depth_;
    uint64_t max_rounds_;
    std::string tile_defines_;
    Tiles tiles_;
    gl::Texture2D rays_;
    gl::Texture2D answers_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray vertex_array_;
    std::optional<BoundedPasses> bounded_;              // the skip-pointer BVH's
    std::array<std::optional<gl::Program>, 2> kernels_; // nearest hit, occlusion
    std::optional<gl::Program> retire_;
};

} // namespace ovc::thesis
