// SPDX-License-Identifier: Apache-2.0
// Decides by severity which KHR_debug messages reach the log.
#include "gpu/gl/debug_output.h"

#include "gpu/gl/gl.h"

#include <cassert>
#include <string>
#include <utility>

namespace ovc {
namespace {

void APIENTRY forward(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei length,
                      const GLchar* message, const void* user) {
    const bool error = type == GL_DEBUG_TYPE_ERROR;
    // Medium and low severity is the driver's advice on speed; notifications only record its steps.
    if (!error && severity != GL_DEBUG_SEVERITY_HIGH)
        return;
    // Mesa's compiler warns of functions of its own; a kernel that does not compile is an error
    // that link_program() returns.
    if (!error && source == GL_DEBUG_SOURCE_SHADER_COMPILER)
        return;
    say(*static_cast<const LogSink*>(user), error ? LogLevel::Error : LogLevel::Warning,
        "OpenGL: " + std::string(message, size_t(length)));
    // Running out of memory is not a mistake of ours: it is reported as a result.
    assert(!error || std::string(message).find("GL_OUT_OF_MEMORY") != std::string::npos);
}

} // namespace

DebugOutput::DebugOutput(LogSink log) : log_(std::make_unique<LogSink>(std::move(log))) {
    glEnable(GL_DEBUG_OUTPUT);
#ifndef NDEBUG
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
#endif
    glDebugMessageCallback(forward, log_.get());
}

DebugOutput::~DebugOutput() {
    if (log_)
        glDebugMessageCallback(nullptr, nullptr);
}

} // namespace ovc
