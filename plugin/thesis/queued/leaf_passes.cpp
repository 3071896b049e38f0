// SPDX-License-Identifier: Apache-2.0
// LeafPasses: the page goes into the pool, rays go in by a texture, and answers come out by a
// framebuffer object. Based on: thesis, sections 3.1 and 3.4.
#include "plugin/thesis/queued/leaf_passes.h"

#include "core/system/stopwatch.h"
#include "gpu/gl/gl_check.h"
#include "gpu/gl/kernel.h"
#include "gpu/gl/workarounds.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace ovc::thesis {
namespace {

/// The locations of uniforms in leaf.frag.glsl.
constexpr GLint kPageUnit = 0;
constexpr GLint kFirstOcclusionRay = 1;

} // namespace

LeafPasses::LeafPasses(std::unique_ptr<Ledger> ledger, const ovc::MemoryPlan& plan,
                       const DeviceInfo& device, std::span<const Page> pages, bool certify)
    : ledger_(std::move(ledger)),
      pages_(pages),
      software_(device.is_software),
      certify_(certify),
      rays_(*ledger_, GL_RGBA32UI, sizeof(uvec4), kRowRays * OVC_FRAME_RAY_TEXELS,
            plan.batch_rays / kRowRays, "rays"),
      answers_(*ledger_, GL_RGBA32UI, sizeof(FrameAnswer), kRowRays, plan.batch_rays / kRowRays,
               "answers"),
      framebuffer_(answers_),
      pool_(*ledger_, uploads_, {plan.pool_bytes, plan.buffer_bytes}, pages.size()) {
    pool_.show();
}

Result<std::unique_ptr<LeafPasses>> LeafPasses::create(const ovc::MemoryPlan& plan,
                                                       const DeviceInfo& device,
                                                       std::span<const Page> pages, bool certify) {
    auto ledger = std::make_unique<Ledger>();
    ledger->budget = plan.budget_bytes;
    std::unique_ptr<LeafPasses> passes(
        new LeafPasses(std::move(ledger), plan, device, pages, certify));
    if (Result<Done> ok = check_gl("allocating the page pool and the ray textures"); !ok)
        return ok.error();
    if (!passes->framebuffer_.complete())
        return Error{"the driver cannot render to RGBA32UI textures, which answers come back in"};
    return passes;
}

/// Returns the one kernel for all pages, which is compiled for the deepest page.
Result<GLuint> LeafPasses::kernel() {
    if (kernel_)
        return kernel_->id();
    uint64_t units = 0;
    for (const Page& page : pages_)
        units = std::max(units, page.units());
    ShaderConfig config;
    config.certify = certify_;
    config.stack_depth = stack_depth(pages_);
    config.stack = software_ ? StackPlace::Registers : StackPlace::Array;
    config.branches = !software_;
    config.reads = software_ ? TexelReads::Images : TexelReads::Textures;
    if (needs(Workaround::CountedRounds) && units > kMaxCountedRounds)
        config.max_rounds = kMaxCountedRounds;
    const std::array<ShaderStage, 2> stages = {
        {{GL_VERTEX_SHADER, "fullscreen.vert.glsl"}, {GL_FRAGMENT_SHADER, "leaf.frag.glsl"}}};
    Result<gl::Program> linked = link_program(stages, config.defines());
    if (!linked)
        return linked.error();
    return kernel_.emplace(std::move(*linked)).id();
}

/// Makes the leaf's page resident. Returns how many bytes were moved for that.
uint64_t LeafPasses::bring(uint32_t leaf) {
    assert(leaf < pages_.size());
    Residency& residency = pool_.residency();
    if (residency.resident(leaf)) {
        residency.touch(leaf);
        return 0;
    }
    std::vector<uint32_t> evicted;
    residency.admit(leaf, pages_[leaf].bytes(), residency.now(), evicted); // any page may go
    pool_.upload(pool_.residency().slot(leaf).offset, pages_[leaf].view());
    return pages_[leaf].bytes();
}

Result<LeafPass> LeafPasses::run(uint32_t leaf, std::span<const FrameRay> rays,
                                 size_t first_occlusion, std::span<FrameAnswer> answers) {
    assert(!rays.empty() && rays.size() == answers.size() && rays.size() % kRowRays == 0);
    assert(first_occlusion <= rays.size());
    const Stopwatch watch;
    const Result<GLuint> program = kernel();
    if (!program)
        return program.error();
    LeafPass pass;
    pass.bytes_in = bring(leaf);
    const GLsizei rows = GLsizei(rays.size() / kRowRays);
    glTextureSubImage2D(rays_.id(), 0, 0, 0, kRowRays * OVC_FRAME_RAY_TEXELS, rows, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, rays.data());

    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, leaf, -1, "pass over a leaf");
    glProgramUniform1i(*program, kPageUnit,
                       GLint(pool_.residency().slot(leaf).offset / OVC_UNIT_BYTES));
    glProgramUniform1i(*program, kFirstOcclusionRay, GLint(first_occlusion));
    glUseProgram(*program);
    pool_.bind(software_ ? TexelReads::Images : TexelReads::Textures); // as the kernel reads
    glBindTextureUnit(OVC_BINDING_RAYS, rays_.id());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glBindVertexArray(vertex_array_.id());
    glViewport(0, 0, kRowRays, rows);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, kRowRays, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT, answers.data());
    glPopDebugGroup();
    if (Result<Done> ok = check_gl("tracing a pass"); !ok)
        return ok.error();
    pass.seconds = watch.seconds();
    return pass;
}

} // namespace ovc::thesis
