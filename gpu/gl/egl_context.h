// SPDX-License-Identifier: Apache-2.0
// A headless OpenGL 4.5 context through EGL, on any device that EGL lists.
#pragma once

#include "core/result.h"
#include "core/system/log.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

/// A driver's description of itself, with limits clamped to values that are known to work.
struct DeviceInfo {
    std::string renderer;
    std::string vendor;
    std::string version;
    bool is_software = false;
    bool is_tested = false;   // all our tests have run on a driver of this kind
    bool has_ballots = false; // lanes of a subgroup can vote: GL_ARB_shader_ballot
    /// A software renderer can use the process's own pages as buffers, without a copy:
    /// GL_AMD_pinned_memory.
    bool takes_host_pages = false;
    uint32_t max_texture_size = 0;
    uint64_t max_buffer_texels = 0;
    uint32_t subgroup_lanes =
        0; // as the driver reports it (GL_KHR_shader_subgroup); 0: it does not
    uint32_t max_pool_buffers = 1; // that a kernel can read beside its other inputs
    /// The same by TexelReads; what a variant may try.
    std::array<uint32_t, 3> pool_buffers_by_reads{1, 1, 1};
    /// How many passes of a kernel may be under way together: 1 where each must be over before
    /// anything else is sent (Workaround::FinishedPass), so that its answers wait for nothing.
    uint32_t passes_in_flight = 1;
    uint64_t max_storage_bytes = 0;   // of one storage buffer
    uint64_t buffer_alignment = 16;   // bytes, of windows into a buffer
    uint64_t memory_bytes = 0;        // free, as reported; on a software renderer 1 GiB
    uint64_t shared_budget_bytes = 0; // of all scenes together; 0: each has a budget of its own

    /// Whether ray refill works: its ballots have 32 bits.
    bool can_refill() const {
        return has_ballots && (is_software || (subgroup_lanes > 0 && subgroup_lanes <= 32));
    }
    /// The bytes that a scene may use when the host names no budget for it: those that it shares
    /// with others, or the free memory less an eighth, for the driver and other programs.
    uint64_t default_budget_bytes() const {
        return shared_budget_bytes ? shared_budget_bytes : memory_bytes - memory_bytes / 8;
    }
};

/// Error: EGL_PLATFORM is set to a name that no EGL knows. Overcast opens no window system, but the
/// user should hear of the mistake.
Result<Done> check_egl_environment();

/// A context with its display. It is current on one thread at most, and must be destroyed on that
/// thread.
class EglContext {
public:
    /// Returns a context that is current on this thread. name: empty for the first GPU, else the
    /// software renderer; a number as list() numbers devices; or part of a renderer's name, in any
    /// case. Error: every device that was tried, with EGL's reason.
    static Result<EglContext> create(const std::string& name, const LogSink& log);

    /// One entry per device, in the order that numbers name them.
    static Result<std::vector<DeviceInfo>> list();

    EglContext(EglContext&& other) noexcept;
    EglContext& operator=(EglContext&& other) noexcept;
    ~EglContext();

    /// Makes the context current on this thread; create() has done so already.
    bool make_current() const;

    const DeviceInfo& info() const { return info_; }

    /// False when the context is not current on this thread any more, when another user of the
    /// display has ended it, or when the driver reports that a reset of the GPU has taken the
    /// context with all its objects.
    bool alive() const;

    /// Destroys the context as a reset does. Tests call it, and GlThread does for a dead context.
    void lose();

private:
    EglContext() = default;
    struct Platform;
    static Result<std::vector<Platform>> platforms();
    static Result<EglContext> open(const Platform& platform);

    void* display_ = nullptr; // EGLDisplay
    void* context_ = nullptr; // EGLContext
    DeviceInfo info_;
};

} // namespace ovc
