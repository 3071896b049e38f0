// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/uploads.h"

#include <algorithm>
#include <cassert>

namespace ovc {

Uploads::Uploads(bool behind_passes, uint64_t ring_bytes) {
    constexpr uint64_t kMaxBytes = 16 << 20;
    if (!behind_passes)
        return;
    auto staged = std::make_unique<Staged>(std::min(kMaxBytes, ring_bytes));
    if (!staged->memory.memory().empty())
        staged_ = std::move(staged);
}

void Uploads::write(const gl::Buffer& buffer, uint64_t to, uint64_t bytes,
                    FunctionRef<void(std::span<std::byte>)> fill) const {
    assert(to + bytes <= buffer.bytes());
    if (bytes == 0)
        return;
    if (staged_ && bytes <= max_bytes()) {
        staged_->ring.write(bytes, buffer.id(), to, fill);
        return;
    }
    void* const memory = glMapNamedBufferRange(buffer.id(), GLintptr(to), GLsizeiptr(bytes),
                                               GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT);
    if (!memory)
        return; // the context is lost; GlThread notices that
    fill({static_cast<std::byte*>(memory), bytes});
    glUnmapNamedBuffer(buffer.id());
}

} // namespace ovc
