// SPDX-License-Identifier: Apache-2.0
// Reads the parts of a HostState.
#include "tests/misuse/host_state.h"

#include "gpu/gl/gl.h"

#include <array>
#include <clocale>
#include <csignal>
#include <fenv.h>
#include <filesystem>
#include <unistd.h>
#include <vector>
#include <xmmintrin.h>

namespace ovc::test {
namespace {

template <class T>
std::string bytes(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Returns a set's members, because the system fills in only a part of a sigset_t.
std::string members(const sigset_t& set) {
    std::string found;
    for (int signal = 1; signal < NSIG; ++signal)
        found += sigismember(&set, signal) == 1 ? '1' : '0';
    return found;
}

void add_thread(HostState& state) {
    state["MXCSR"] = bytes(_mm_getcsr());
    uint16_t x87_control, x87_status;
    asm volatile("fnstcw %0; fnstsw %1" : "=m"(x87_control), "=m"(x87_status));
    state["x87 control word"] = bytes(x87_control);
    state["x87 status word"] = bytes(x87_status);
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    state["signal mask"] = members(blocked);
    stack_t stack;
    sigaltstack(nullptr, &stack);
    state["signal stack"] = bytes(stack.ss_sp) + bytes(stack.ss_flags) + bytes(stack.ss_size);
    std::array<char, 16> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    state["thread name"] = bytes(name);
    cpu_set_t cores;
    sched_getaffinity(0, sizeof cores, &cores);
    state["affinity"] = bytes(cores);
}

void add_process(HostState& state) {
    std::string environment = bytes(environ);
    for (char** entry = environ; *entry; ++entry)
        environment += bytes(*entry) + *entry + '\n';
    state["environment"] = environment;
    for (int signal = 1; signal < NSIG; ++signal) {
        struct sigaction action {};
        if (sigaction(signal, nullptr, &action) == 0)
            state["handler of signal " + std::to_string(signal)] =
                bytes(action.sa_handler) + bytes(action.sa_flags) + members(action.sa_mask);
    }
    state["locale"] = std::setlocale(LC_ALL, nullptr);
    state["current folder"] = std::filesystem::current_path();
}

void add_egl(HostState& state) {
    state["EGL context"] = bytes(eglGetCurrentContext());
    state["EGL display"] = bytes(eglGetCurrentDisplay());
    state["EGL surfaces"] =
        bytes(eglGetCurrentSurface(EGL_DRAW)) + bytes(eglGetCurrentSurface(EGL_READ));
    state["EGL API"] = bytes(eglQueryAPI());
}

/// Adds the state that renderers bind and set. A value that a driver does not know keeps the
/// marker.
void add_gl(HostState& state) {
    constexpr GLenum kValues[] = {
        GL_ACTIVE_TEXTURE,
        GL_ARRAY_BUFFER_BINDING,
        GL_BLEND,
        GL_BLEND_DST_RGB,
        GL_BLEND_SRC_RGB,
        GL_COLOR_CLEAR_VALUE,
        GL_COLOR_WRITEMASK,
        GL_COPY_READ_BUFFER_BINDING,
        GL_CULL_FACE,
        GL_CULL_FACE_MODE,
        GL_CURRENT_PROGRAM,
        GL_DEPTH_FUNC,
        GL_DEPTH_TEST,
        GL_DEPTH_WRITEMASK,
        GL_DISPATCH_INDIRECT_BUFFER_BINDING,
        GL_DRAW_BUFFER,
        GL_DRAW_FRAMEBUFFER_BINDING,
        GL_ELEMENT_ARRAY_BUFFER_BINDING,
        GL_FRONT_FACE,
        GL_LINE_WIDTH,
        GL_PACK_ALIGNMENT,
        GL_PACK_ROW_LENGTH,
        GL_PIXEL_PACK_BUFFER_BINDING,
        GL_PIXEL_UNPACK_BUFFER_BINDING,
        GL_PRIMITIVE_RESTART,
        GL_PROGRAM_PIPELINE_BINDING,
        GL_READ_BUFFER,
        GL_READ_FRAMEBUFFER_BINDING,
        GL_RENDERBUFFER_BINDING,
        GL_SAMPLER_BINDING,
        GL_SCISSOR_BOX,
        GL_SCISSOR_TEST,
        GL_SHADER_STORAGE_BUFFER_BINDING,
        GL_STENCIL_TEST,
        GL_TEXTURE_BINDING_2D,
        GL_TEXTURE_BINDING_BUFFER,
        GL_TRANSFORM_FEEDBACK_BUFFER_BINDING,
        GL_UNIFORM_BUFFER_BINDING,
        GL_UNPACK_ALIGNMENT,
        GL_UNPACK_ROW_LENGTH,
        GL_VERTEX_ARRAY_BINDING,
        GL_VIEWPORT,
    };
    for (const GLenum name : kValues) {
        std::array<GLfloat, 4> value{-77, -77, -77, -77};
        glGetFloatv(name, value.data());
        state["GL value " + std::to_string(name)] = bytes(value);
    }
    std::array<unsigned char, 4 * 4 * 4> pixels{};
    glReadPixels(0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    state["pixels"] = bytes(pixels);
    state["GL error"] = bytes(glGetError());
}

} // namespace

HostState host_state() {
    HostState state;
    // The thread comes first, because the rest computes.
    add_thread(state);
    add_process(state);
    add_egl(state);
    if (eglGetCurrentContext() != EGL_NO_CONTEXT)
        add_gl(state);
    return state;
}

std::string difference(const HostState& before, const HostState& after) {
    std::string names;
    for (const auto& [name, value] : before) {
        const auto found = after.find(name);
        if (found == after.end() || found->second != value)
            names += name + "; ";
    }
    return names + (before.size() == after.size() ? "" : "more parts than before");
}

} // namespace ovc::test
