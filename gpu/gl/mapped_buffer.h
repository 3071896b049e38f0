// SPDX-License-Identifier: Apache-2.0
// MappedBuffer: memory of the driver that this process can use while the device copies from it or
// to it. It is no GPU memory, and does not count for a budget.
#pragma once

#include "gpu/gl/gl_object.h"

#include <cstddef>
#include <span>

namespace ovc::gl {

class MappedBuffer {
public:
    /// access: GL_MAP_WRITE_BIT or GL_MAP_READ_BIT, what this process does.
    MappedBuffer(size_t bytes, GLbitfield access) : handle_(create_buffer()) {
        const GLbitfield mapped = access | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
        glNamedBufferStorage(id(), GLsizeiptr(bytes), nullptr, mapped | GL_CLIENT_STORAGE_BIT);
        void* const memory = glMapNamedBufferRange(id(), 0, GLsizeiptr(bytes), mapped);
        if (memory)
            memory_ = {static_cast<std::byte*>(memory), bytes};
        else
            glGetError(); // whoever wants it does without
    }
    GLuint id() const { return handle_.id(); }
    /// Stays where it is; empty where the driver gives none. What the device copies is there once a
    /// fence behind the copy is passed; what it copies from may change once that fence is passed.
    std::span<std::byte> memory() const { return memory_; }

private:
    Handle<delete_buffer> handle_;
    std::span<std::byte> memory_;
};

} // namespace ovc::gl
