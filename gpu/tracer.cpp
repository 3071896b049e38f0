// SPDX-License-Identifier: Apache-2.0
// Tracer: rays in by a texture, the kernel over a rectangle of pixels, answers out by a framebuffer
// object. Based on: thesis, section 3.1.
#include "gpu/tracer.h"

#include "shaders/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>

namespace ovc {
namespace {

constexpr uint32_t kMaxBatchRows = 512; // half a million rays: beyond, a pass gains nothing more
/// llvmpipe ends a loop after 65,535 rounds without a word. The kernel's loop comes to each unit of
/// a page once at most, so smaller pages need no count.
constexpr uint32_t kMostRoundsInSoftware = 65000;
constexpr uint64_t kSmallestPool = 16384; // a page of some hundred triangles

Result<Done> check_gl(const char* doing) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR)
        return Done{};
    while (glGetError() != GL_NO_ERROR) {
    }
    if (error == GL_OUT_OF_MEMORY)
        return Error{
            fmt::format("the GPU is out of memory while {}; a smaller budget may work", doing)};
    return Error{fmt::format("OpenGL error 0x{:04x} while {}", error, doing)};
}

uint32_t round_up(uint32_t n, uint32_t step) {
    return (n + step - 1) / step * step;
}

} // namespace

Result<MemoryPlan> plan_memory(uint64_t budget_bytes, const DeviceInfo& device) {
    MemoryPlan plan;
    plan.budget_bytes = budget_bytes;
    plan.batch_rays = Tracer::kRowRays;
    const uint64_t smallest = plan.ray_bytes() + kSmallestPool;
    if (budget_bytes < smallest)
        return Error{fmt::format("a GPU budget of {} bytes is too small: the smallest that works "
                                 "is {} bytes ({} for rays and answers, {} for a page)",
                                 budget_bytes, smallest, plan.ray_bytes(), kSmallestPool)};
    // An eighth for rays: batches of ten thousand and more already run at full speed, and pages
    // want the rest.
    const uint64_t rows = budget_bytes / 8 / plan.ray_bytes();
    plan.batch_rays *= uint32_t(
        std::clamp<uint64_t>(rows, 1, std::min<uint64_t>(kMaxBatchRows, device.max_texture_size)));
    plan.pool_bytes =
        (budget_bytes - plan.ray_bytes()) / device.buffer_alignment * device.buffer_alignment;
    plan.pool_bytes = std::min(plan.pool_bytes, device.max_buffer_texels * sizeof(uvec4));
    return plan;
}

Tracer::Tracer(std::unique_ptr<Ledger> ledger, const MemoryPlan& plan, const DeviceInfo& device,
               KernelCache& kernels, size_t leaves)
    : ledger_(std::move(ledger)),
      kernels_(kernels),
      software_(device.is_software),
      rays_(*ledger_, GL_RGBA32UI, sizeof(uvec4), kRowRays * OVC_RAY_TEXELS,
            plan.batch_rays / kRowRays, "rays"),
      answers_(*ledger_, GL_RGBA32UI, sizeof(LocalAnswer), kRowRays, plan.batch_rays / kRowRays,
               "answers"),
      framebuffer_(answers_),
      pool_(*ledger_, plan.pool_bytes, device.buffer_alignment, leaves) {}

Result<std::unique_ptr<Tracer>> Tracer::create(const MemoryPlan& plan, const DeviceInfo& device,
                                               KernelCache& kernels, size_t leaves) {
    auto ledger = std::make_unique<Ledger>();
    ledger->budget = plan.budget_bytes;
    std::unique_ptr<Tracer> tracer(new Tracer(std::move(ledger), plan, device, kernels, leaves));
    if (Result<Done> ok = check_gl("allocating the page pool and the ray textures"); !ok)
        return ok.error();
    if (!tracer->framebuffer_.complete())
        return Error{"the driver cannot render to RGBA32UI textures, which answers come back in"};
    return tracer;
}

Result<PassResult> Tracer::pass(uint32_t leaf, const Page& page, const PassOptions& options,
                                std::span<const LocalRay> rays, std::span<LocalAnswer> answers) {
    assert(!rays.empty() && rays.size() == answers.size());
    const auto start = std::chrono::steady_clock::now();
    ShaderConfig config;
    config.compute = options.compute;
    config.any_hit = options.any_hit;
    config.certify = options.certify;
    config.stack_depth = round_up(page.depth, 4); // few programs, no register more than needed
    config.stack_registers = software_;
    config.page_image = software_;
    if (software_ && page.units() > kMostRoundsInSoftware)
        config.most_rounds = kMostRoundsInSoftware;
    const Result<GLuint> program = kernels_.program(config);
    if (!program)
        return program.error();

    PassResult result;
    const Slot slot = pool_.bring(leaf, page, result.bytes_in);
    page_.show(pool_.buffer(), GL_RGBA32UI, slot.offset, page.bytes());
    const GLsizei rows = GLsizei(row_padded(rays.size()) / kRowRays);
    glTextureSubImage2D(rays_.id(), 0, 0, 0, kRowRays * OVC_RAY_TEXELS, rows, GL_RGBA_INTEGER,
                        GL_UNSIGNED_INT, rays.data());

    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, leaf, -1, "pass over a leaf");
    glUseProgram(*program);
    if (config.page_image)
        glBindImageTexture(OVC_BINDING_PAGE, page_.id(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32UI);
    else
        glBindTextureUnit(OVC_BINDING_PAGE, page_.id());
    glBindTextureUnit(OVC_BINDING_RAYS, rays_.id());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    if (config.compute) {
        static_assert(kRowRays % OVC_GROUP_SIZE == 0);
        glBindImageTexture(OVC_BINDING_ANSWERS, answers_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY,
                           GL_RGBA32UI);
        glDispatchCompute(kRowRays / OVC_GROUP_SIZE, GLuint(rows), 1);
        glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);
    } else {
        glBindVertexArray(vertex_array_.id());
        glViewport(0, 0, kRowRays, rows);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glReadPixels(0, 0, kRowRays, rows, GL_RGBA_INTEGER, GL_UNSIGNED_INT, answers.data());
    glPopDebugGroup();
    if (Result<Done> ok = check_gl("tracing a pass"); !ok)
        return ok.error();
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

} // namespace ovc
