// SPDX-License-Identifier: Apache-2.0
// Runner: rays go in by a texture, fragments trace them, and answers come out by a framebuffer
// object. Based on: thesis, section 3.1.
#include "plugin/thesis/runner.h"

#include "core/text/format_text.h"
#include "gpu/gl/gl_check.h"
#include "gpu/gl/kernel.h"
#include "gpu/gl/workarounds.h"
#include "shaders/layout.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {
namespace {

constexpr uint64_t kMaxRows = 512; // half a million rays; a pass gains nothing from more

uint64_t row_bytes(ovc_structure structure) {
    const uint64_t state = structure == OVC_STRUCTURE_SKIP_BVH ? BoundedPasses::kBytesPerRay : 0;
    return Runner::kRowRays * (sizeof(FrameRay) + sizeof(FrameAnswer) + state);
}

} // namespace

uint32_t MemoryPlan::batch_rays() const {
    return rows * Runner::kRowRays;
}

Result<MemoryPlan> plan_memory(const RunnerOptions& options, uint64_t texels,
                               const char* at_least) {
    MemoryPlan plan;
    plan.tiles = plan_tiles(texels, options.textures);
    const uint32_t allowed = options.structure == OVC_STRUCTURE_MULTI_TEXTURE ? kMaxTextures : 1;
    if (plan.tiles.count() > allowed)
        return over_budget(format_text(
            "{}: the scene takes {}{} bytes; a texture of 4096 x 4096 texels "
            "holds {}, and it uses {}",
            name_of(options.structure), at_least, texels * sizeof(uvec4), kTextureBytes, allowed));
    const uint64_t row = row_bytes(options.structure);
    const uint64_t scene = plan.tiles.bytes();
    if (options.budget_bytes < scene + row)
        return over_budget(format_text(
            "{}: a GPU budget of {} bytes is too small: the smallest that works is {}{} bytes ({} "
            "for the scene, which it holds whole, {} for rays and answers)",
            name_of(options.structure), options.budget_bytes, at_least, scene + row, scene, row));
    plan.rows = uint32_t(std::min((options.budget_bytes - scene) / row, kMaxRows));
    assert(plan.rows > 0);
    return plan;
}

Runner::Runner(std::unique_ptr<Ledger> ledger, const RunnerOptions& options, const MemoryPlan& plan,
               System system, bool software)
    : ledger_(std::move(ledger)),
      options_(options),
      software_(software),
      stack_depth_(system.stack_depth),
      max_rounds_(system.max_rounds),
      tile_defines_(plan.tiles.defines()),
      tiles_(*ledger_, plan.tiles, std::move(system.texels)),
      rays_(*ledger_, GL_RGBA32UI, sizeof(uvec4), kRowRays * OVC_FRAME_RAY_TEXELS, plan.rows,
            "rays"),
      answers_(*ledger_, GL_RGBA32UI, sizeof(FrameAnswer), kRowRays, plan.rows, "answers"),
      framebuffer_(answers_) {
    if (options.structure == OVC_STRUCTURE_SKIP_BVH)
        bounded_.emplace(*ledger_, answers_, kRowRays, plan.rows);
}

Result<std::unique_ptr<Runner>> Runner::create(const RunnerOptions& options, const MemoryPlan& plan,
                                               System system, bool software) {
    auto ledger = std::make_unique<Ledger>();
    ledger->budget = options.budget_bytes;
    std::unique_ptr<Runner> runner(
        new Runner(std::move(ledger), options, plan, std::move(system), software));
    if (Result<Done> ok = check_gl("allocating the textures of the scene and of rays"); !ok)
        return ok.error();
    if (!runner->framebuffer_.complete() || (runner->bounded_ && !runner->bounded_->complete()))
        return Error{"the driver cannot render to the textures that answers come back in"};
    return runner;
}

Result<GLuint> Runner::link(std::optional<gl::Program>& program, const char* fragment,
                            bool any_hit) {
    if (program)
        return program->id();
    ShaderConfig config;
    config.any_hit = any_hit;
    config.certify = options_.certify;
    config.stack_depth = stack_depth_;
    config.stack = software_ ? StackPlace::Registers : StackPlace::Array;
    config.branches = !software_;
    if (needs(Workaround::CountedRounds) && max_rounds_ > kMaxCountedRounds)
        config.max_rounds = kMaxCountedRounds;
    const std::string defines = config.defines() + tile_defines_ +
                                format_text("#define OVC_STRUCTURE {}\n", int(options_.structure));
    const std::array<ShaderStage, 2> stages = {
        {{GL_VERTEX_SHADER, "fullscreen.vert.glsl"}, {GL_FRAGMENT_SHADER, fragment}}};
    Result<gl::Program> linked = link_program(stages, defines);
    if (!linked)
        return linked.error();
    return program.emplace(std::move(*linked)).id();
}

Result<uint64_t> Runner::trace(bool any_hit, std::span<const FrameRay> rays,
                               std::span<FrameAnswer> answers) {
    assert(!rays.empty() && rays.size() == answers.size() && rays.size() % kRowRays == 0);
    const Result<GLuint> kernel =
        link(kernels_[any_hit], bounded_ ? "skip_bvh.frag.glsl" : "thesis.frag.glsl", any_hit);
    if (!kernel)
        return kernel.error();
    const GLsizei rows = GLsizei(rays.size() / kRowRays);
    glTextureSubImage2D(rays_.id(), 0, 0, 0, kRowRays * OVC_FRAME_RAY_TEXELS, rows, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, rays.data());
    tiles_.bind();
    glBindTextureUnit(OVC_BINDING_RAYS, rays_.id());
    glBindVertexArray(vertex_array_.id());
    glViewport(0, 0, kRowRays, rows);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    uint64_t passes = 1;
    if (bounded_) {
        const Result<GLuint> retire = link(retire_, "retire.frag.glsl", /* any_hit= */ false);
        if (!retire)
            return retire.error();
        passes = bounded_->run(*kernel, *retire, uint32_t(rows));
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    } else {
        glUseProgram(*kernel);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glReadPixels(0, 0, kRowRays, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT, answers.data());
    if (Result<Done> ok = check_gl("tracing a pass"); !ok)
        return ok.error();
    return passes;
}

} // namespace ovc::thesis
