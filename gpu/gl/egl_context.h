// SPDX-License-Identifier: Apache-2.0
// A headless OpenGL 4.5 context through EGL, on any device that EGL lists.
#pragma once

#include "core/result.h"
#include "core/system/log.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc {

/// What a driver says of itself, after clamping to what was found to work.
struct DeviceInfo {
    std::string renderer;
    std::string vendor;
    std::string version;
    bool is_software = false;
    bool is_tested = false;   // all our tests have run on a driver of this kind
    bool has_ballots = false; // lanes of a subgroup can tell each other: GL_ARB_shader_ballot
    /// A software renderer that uses buffers of the process's own pages where they are:
    /// GL_AMD_pinned_memory.
    bool takes_host_pages = false;
    uint32_t max_texture_size = 0;
    uint64_t max_buffer_texels = 0;
    uint32_t max_pool_buffers = 1;  // that a kernel can read besides its other inputs
    uint64_t buffer_alignment = 16; // bytes, of windows into a buffer
    uint64_t memory_bytes = 0;      // free, as reported; on a software renderer 1 GiB

    /// What a scene may use when nobody says how much: the free memory less an eighth, for the
    /// driver and others.
    uint64_t default_budget_bytes() const { return memory_bytes - memory_bytes / 8; }
};

/// Error: EGL_PLATFORM is set to what no EGL knows. Overcast opens no window system, but a mistake
/// is worth saying.
Result<Done> check_egl_environment();

/// A context, with its display. Current on one thread at most; destroyed on the thread it is
/// current on.
class EglContext {
public:
    /// name: empty for the first GPU, else the software renderer; a number as list() numbers them,
    /// or part of a renderer's name, any case. Error: what was tried and what EGL said.
    static Result<EglContext> create(const std::string& name, const LogSink& log);

    /// One entry per device, in the order that numbers name them.
    static Result<std::vector<DeviceInfo>> list();

    EglContext(EglContext&& other) noexcept;
    EglContext& operator=(EglContext&& other) noexcept;
    ~EglContext();

    /// Makes it current on this thread; create() has done so already.
    bool make_current() const;

    const DeviceInfo& info() const { return info_; }

    /// False when it is not current on this thread any more, the display was ended by whoever
    /// shares it, or the driver says that a reset of the GPU has taken it and all that was in it.
    bool alive() const;

    /// For tests: what a reset does.
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
