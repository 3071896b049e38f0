// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/uploads.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>
#include <cstring>

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
        return; // the context is lost, or GL keeps the error, which fails the next pass
    fill({static_cast<std::byte*>(memory), bytes});
    glUnmapNamedBuffer(buffer.id());
}

void Uploads::copy(std::span<const std::byte> bytes, const gl::Buffer& buffer) const {
    constexpr uint64_t kPartBytes = 4 << 20;
    constexpr size_t kGrain = 256 << 10; // bytes that a task copies
    assert(bytes.size() <= buffer.bytes());
    if (!staged_) {
        glNamedBufferSubData(buffer.id(), 0, GLsizeiptr(bytes.size()), bytes.data());
        return;
    }
    const uint64_t part_bytes = std::min(kPartBytes, max_bytes());
    for (uint64_t begin = 0; begin < bytes.size(); begin += part_bytes) {
        const auto part = bytes.subspan(begin, std::min(part_bytes, bytes.size() - begin));
        write(buffer, begin, part.size(), [&](std::span<std::byte> memory) {
            parallel_for(part.size(), kGrain, [&](size_t first, size_t last) {
                std::memcpy(memory.data() + first, part.data() + first, last - first);
            });
        });
    }
}

} // namespace ovc
