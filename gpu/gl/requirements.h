// SPDX-License-Identifier: Apache-2.0
// What Overcast needs of EGL and OpenGL, in one list that is checked when a device opens. What a
// driver may offer besides is in DeviceInfo.
#pragma once

#include "core/result.h"
#include "gpu/gl/gl.h"
#include "shaders/layout.h"

#include <array>
#include <functional>
#include <string_view>

namespace ovc {

/// Contexts are made without a surface and without a framebuffer's configuration.
inline constexpr std::array<const char*, 2> kEglExtensions{"EGL_KHR_surfaceless_context",
                                                           "EGL_KHR_no_config_context"};

/// No OpenGL extension is needed. GL_ARB_shader_ballot, GL_ARB_gpu_shader_int64 and
/// GL_AMD_pinned_memory are used where they are offered.
inline constexpr int kGlMajor = 4;
inline constexpr int kGlMinor = 5;

struct LimitRequirement {
    GLenum limit;
    std::string_view name;
    int needed;
};

/// Every driver of OpenGL 4.5 that keeps to its specification has more than these.
inline constexpr std::array<LimitRequirement, 8> kLimits{{
    {GL_MAX_TEXTURE_SIZE, "GL_MAX_TEXTURE_SIZE", 16384},
    {GL_MAX_TEXTURE_BUFFER_SIZE, "GL_MAX_TEXTURE_BUFFER_SIZE", 65536},
    {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS",
     OVC_MAX_GROUP_SIZE},
    {GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS, "GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS",
     OVC_BINDING_POOL + 1},
    {GL_MAX_TEXTURE_IMAGE_UNITS, "GL_MAX_TEXTURE_IMAGE_UNITS", OVC_BINDING_POOL + 1},
    {GL_MAX_COMPUTE_IMAGE_UNIFORMS, "GL_MAX_COMPUTE_IMAGE_UNIFORMS", OVC_BINDING_POOL + 1},
    {GL_MAX_FRAGMENT_IMAGE_UNIFORMS, "GL_MAX_FRAGMENT_IMAGE_UNIFORMS", OVC_BINDING_POOL + 1},
    {GL_MAX_IMAGE_UNITS, "GL_MAX_IMAGE_UNITS", OVC_BINDING_POOL + 1},
}};

/// Returns the value of a limit, or of GL_MAJOR_VERSION and GL_MINOR_VERSION.
using AskDriver = std::function<int(GLenum)>;

/// Error: a sentence that names every requirement that the driver does not meet, with what it
/// offers. renderer: the name for the sentence.
Result<Done> check_requirements(std::string_view renderer, const AskDriver& ask);

} // namespace ovc
