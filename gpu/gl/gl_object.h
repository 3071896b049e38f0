// SPDX-License-Identifier: Apache-2.0
// GL objects as move-only values: the constructor creates, the destructor deletes, and a moved-from
// object has id 0. All calls need the context current.
#pragma once

#include "core/system/system_pages.h"
#include "gpu/budget/ledger.h"
#include "gpu/gl/gl.h"
#include "gpu/gl/texel_reads.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string_view>
#include <utility>

namespace ovc::gl {

/// How many contexts this thread has had, as GlThread counts them. Names of an earlier context mean
/// nothing in the present one.
inline thread_local uint32_t context_generation = 0;

/// Owns one GL name. Delete: void(GLuint). A name whose context is gone is not deleted.
template <auto Delete>
class Handle {
public:
    explicit Handle(GLuint id) : id_(id), generation_(context_generation) {}
    Handle(Handle&& other) noexcept
        : id_(std::exchange(other.id_, 0)), generation_(other.generation_) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(generation_, other.generation_);
        return *this;
    }
    ~Handle() {
        if (id_ != 0 && generation_ == context_generation)
            Delete(id_);
    }

    GLuint id() const { return id_; }

private:
    GLuint id_;
    uint32_t generation_;
};

/// Bytes entered in a ledger for as long as this lives.
class Entry {
public:
    Entry(Ledger& ledger, uint64_t bytes) : ledger_(&ledger), bytes_(bytes) { ledger.add(bytes); }
    Entry(Entry&& other) noexcept
        : ledger_(other.ledger_), bytes_(std::exchange(other.bytes_, 0)) {}
    Entry& operator=(Entry&& other) noexcept {
        std::swap(ledger_, other.ledger_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~Entry() { ledger_->remove(bytes_); }

    uint64_t bytes() const { return bytes_; }

private:
    Ledger* ledger_;
    uint64_t bytes_;
};

inline GLuint create_buffer() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
}
inline void delete_buffer(GLuint id) {
    glDeleteBuffers(1, &id);
}
inline void delete_texture(GLuint id) {
    glDeleteTextures(1, &id);
}
inline void delete_framebuffer(GLuint id) {
    glDeleteFramebuffers(1, &id);
}
inline void delete_vertex_array(GLuint id) {
    glDeleteVertexArrays(1, &id);
}
inline void delete_query(GLuint id) {
    glDeleteQueries(1, &id);
}
inline void delete_shader(GLuint id) {
    glDeleteShader(id);
}
inline void delete_program(GLuint id) {
    glDeleteProgram(id);
}

using Shader = Handle<delete_shader>;
using Program = Handle<delete_program>;

/// Makes pages of this process the storage of a buffer. The driver reads and writes them in place,
/// so they must outlive the buffer's use. pages: the address of the first.
inline void show_host_pages(GLuint buffer, const void* pages, uint64_t bytes) {
    glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, buffer);
    glBufferData(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, GLsizeiptr(bytes), pages, GL_DYNAMIC_DRAW);
    glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, 0);
}

/// Storage of a fixed size, filled by sub-buffer updates or through a map. If the ledger says so,
/// it consists of the process's own pages, which the driver uses in place; the system provides each
/// page at its first use. The pages go with the buffer, so no pass may be under way when it is
/// destroyed.
class Buffer {
public:
    Buffer(Ledger& ledger, uint64_t bytes, std::string_view label)
        : handle_(create_buffer()), entry_(ledger, bytes) {
        if (!ledger.driver_has_room())
            return;
        if (!ledger.takes_host_pages)
            allocate();
        else if (!make_host_pages())
            ledger.refused = true;
        glObjectLabel(GL_BUFFER, id(), GLsizei(label.size()), label.data());
    }
    GLuint id() const { return handle_.id(); }
    uint64_t bytes() const { return entry_.bytes(); }

private:
    void allocate() {
        glNamedBufferStorage(id(), GLsizeiptr(bytes()), nullptr,
                             GL_DYNAMIC_STORAGE_BIT | GL_MAP_WRITE_BIT);
    }
    /// Returns false if the system has no pages left.
    bool make_host_pages() {
        try {
            host_pages_ = map_pages(bytes());
        } catch (const std::bad_alloc&) {
            return false;
        }
        show_host_pages(id(), host_pages_.get(), bytes());
        return true;
    }

    SystemPages host_pages_; // declared first, so that the pages outlive the name
    Handle<delete_buffer> handle_;
    Entry entry_;
};

/// Pages of this process, which somebody else owns, as a buffer that kernels read. Only where a
/// ledger says that buffers consist of such pages.
class HostBuffer {
public:
    explicit HostBuffer(std::span<const std::byte> pages) : handle_(create_buffer()) {
        show_host_pages(id(), pages.data(), pages.size());
    }
    GLuint id() const { return handle_.id(); }

private:
    Handle<delete_buffer> handle_;
};

/// A two-dimensional texture of one level, unfiltered.
class Texture2D {
public:
    Texture2D(Ledger& ledger, GLenum format, uint32_t texel_bytes, uint32_t width, uint32_t height,
              std::string_view label)
        : handle_(create(GL_TEXTURE_2D)), entry_(ledger, uint64_t(texel_bytes) * width * height) {
        glTextureStorage2D(id(), 1, format, GLsizei(width), GLsizei(height));
        glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glObjectLabel(GL_TEXTURE, id(), GLsizei(label.size()), label.data());
    }
    GLuint id() const { return handle_.id(); }
    static GLuint create(GLenum target) {
        GLuint id = 0;
        glCreateTextures(target, 1, &id);
        return id;
    }

private:
    Handle<delete_texture> handle_;
    Entry entry_;
};

/// A window of a buffer, read as texels. It owns no storage.
class BufferTexture {
public:
    BufferTexture() : handle_(Texture2D::create(GL_TEXTURE_BUFFER)) {}
    GLuint id() const { return handle_.id(); }
    /// offset: a multiple of GL_TEXTURE_BUFFER_OFFSET_ALIGNMENT.
    void show(const Buffer& buffer, GLenum format, uint64_t offset, uint64_t bytes) {
        assert(offset + bytes <= buffer.bytes());
        show(buffer.id(), format, offset, bytes);
    }
    void show(GLuint buffer, GLenum format, uint64_t offset, uint64_t bytes) {
        window_ = {buffer, GLintptr(offset), GLsizeiptr(bytes)};
        glTextureBufferRange(id(), format, buffer, GLintptr(offset), GLsizeiptr(bytes));
    }
    /// Binds the window's RGBA32UI texels for a kernel to read.
    void bind(GLuint unit, TexelReads reads) const {
        if (reads == TexelReads::StorageBuffers)
            glBindBufferRange(GL_SHADER_STORAGE_BUFFER, unit, window_.buffer, window_.offset,
                              window_.bytes);
        else if (reads == TexelReads::Images)
            glBindImageTexture(unit, id(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_RGBA32UI);
        else
            glBindTextureUnit(unit, id());
    }

private:
    struct Window {
        GLuint buffer = 0;
        GLintptr offset = 0;
        GLsizeiptr bytes = 0;
    };
    Window window_;
    Handle<delete_texture> handle_;
};

class Framebuffer {
public:
    Framebuffer() : handle_(create()) {}
    explicit Framebuffer(const Texture2D& color) : Framebuffer() { show(color); }
    void show(const Texture2D& color) {
        glNamedFramebufferTexture(id(), GL_COLOR_ATTACHMENT0, color.id(), 0);
    }
    GLuint id() const { return handle_.id(); }
    bool complete() const {
        return glCheckNamedFramebufferStatus(id(), GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }

private:
    static GLuint create() {
        GLuint id = 0;
        glCreateFramebuffers(1, &id);
        return id;
    }
    Handle<delete_framebuffer> handle_;
};

class VertexArray {
public:
    VertexArray() : handle_(create()) {}
    GLuint id() const { return handle_.id(); }

private:
    static GLuint create() {
        GLuint id = 0;
        glCreateVertexArrays(1, &id);
        return id;
    }
    Handle<delete_vertex_array> handle_;
};

/// Counts the samples that pass the depth test.
class OcclusionQuery {
public:
    OcclusionQuery() : handle_(create()) {}
    GLuint id() const { return handle_.id(); }

private:
    static GLuint create() {
        GLuint id = 0;
        glCreateQueries(GL_SAMPLES_PASSED, 1, &id);
        return id;
    }
    Handle<delete_query> handle_;
};

/// Measures how long the device works on commands, without the time that they wait.
class TimeQuery {
public:
    TimeQuery() : handle_(create()) {}
    GLuint id() const { return handle_.id(); }
    /// Seconds of the commands between glBeginQuery and glEndQuery; waits until they are done.
    double seconds() const {
        GLuint64 nanoseconds = 0;
        glGetQueryObjectui64v(id(), GL_QUERY_RESULT, &nanoseconds);
        return 1e-9 * double(nanoseconds);
    }

private:
    static GLuint create() {
        GLuint id = 0;
        glCreateQueries(GL_TIME_ELAPSED, 1, &id);
        return id;
    }
    Handle<delete_query> handle_;
};

} // namespace ovc::gl
