// SPDX-License-Identifier: Apache-2.0
// Fence: a place in the sequence of GL commands, for which this thread can wait.
#pragma once

#include "gpu/gl/gl.h"
#include "gpu/gl/gl_object.h"

#include <utility>

namespace ovc::gl {

/// Behind everything that was asked of GL before it was made. The context is current in all calls.
class Fence {
public:
    Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}
    Fence(Fence&& other) noexcept
        : sync_(std::exchange(other.sync_, nullptr)), generation_(other.generation_) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        std::swap(generation_, other.generation_);
        return *this;
    }
    ~Fence() {
        if (sync_ && is_alive())
            glDeleteSync(sync_);
    }

    /// Returns once the device has passed it, or has lost the context.
    void wait() const {
        constexpr GLuint64 kSecond = 1000000000;
        GLenum result = is_alive() ? GL_TIMEOUT_EXPIRED : GL_CONDITION_SATISFIED;
        while (result == GL_TIMEOUT_EXPIRED) // a context that is lost says so
            result = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
    }

private:
    /// Whether the context is the one that it was made in; a fence is gone with its context.
    bool is_alive() const { return generation_ == context_generation; }

    GLsync sync_;
    uint32_t generation_ = context_generation;
};

} // namespace ovc::gl
