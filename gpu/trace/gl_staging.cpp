// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/gl_staging.h"

namespace ovc {

GLuint GlStaging::create() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
}

GlStaging::GlStaging(size_t bytes, std::vector<GLuint> buffers)
    : buffers_(std::move(buffers)), buffer_(create()) {
    constexpr GLbitfield kMapped = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    glNamedBufferStorage(buffer_.id(), GLsizeiptr(bytes), nullptr, kMapped | GL_CLIENT_STORAGE_BIT);
    void* const mapped = glMapNamedBufferRange(buffer_.id(), 0, GLsizeiptr(bytes), kMapped);
    if (!mapped)
        glGetError(); // pages are then written without it
    else
        memory_ = {static_cast<std::byte*>(mapped), bytes};
}

GlStaging::~GlStaging() {
    if (!is_alive())
        return;
    for (const GLsync fence : fences_)
        glDeleteSync(fence);
}

void GlStaging::copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) {
    glCopyNamedBufferSubData(buffer_.id(), buffers_[buffer], GLintptr(from), GLintptr(to),
                             GLsizeiptr(bytes));
}

uint64_t GlStaging::fence() {
    fences_.push_back(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    return passed_ + fences_.size();
}

void GlStaging::wait(uint64_t fence) {
    while (is_alive() && passed_ < fence && !fences_.empty()) {
        // A second at a time; a context that is lost says so, and its fences are passed.
        GLenum result = GL_TIMEOUT_EXPIRED;
        while (result == GL_TIMEOUT_EXPIRED)
            result = glClientWaitSync(fences_.front(), GL_SYNC_FLUSH_COMMANDS_BIT, 1000000000);
        glDeleteSync(fences_.front());
        fences_.pop_front();
        ++passed_;
    }
}

} // namespace ovc
