// SPDX-License-Identifier: Apache-2.0
// Pool: writes pages and words to its buffers.
#include "gpu/trace/pool.h"

#include "gpu/page/top_level.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {

Pool::Pool(Ledger& ledger, const PoolLayout& layout, size_t leaves, uint64_t begin)
    : layout_(layout),
      begin_(begin),
      takes_host_pages_(ledger.takes_host_pages),
      residency_(stretches_of(layout, begin), OVC_UNIT_BYTES, leaves) {
    for (uint32_t i = 0; i < layout.count(); ++i)
        buffers_.emplace_back(ledger, layout.bytes_of(i), "page pool");
}

void Pool::show() {
    for (const gl::Buffer& buffer : buffers_)
        texels_.emplace_back().show(buffer, GL_RGBA32UI, 0, buffer.bytes());
    if (!takes_host_pages_)
        stage();
}

void Pool::stage() {
    constexpr uint64_t kMaxBytes = 16 << 20;
    std::vector<GLuint> names;
    for (const gl::Buffer& buffer : buffers_)
        names.push_back(buffer.id());
    const uint64_t bytes = std::min(kMaxBytes, layout_.bytes);
    auto staged = std::make_unique<Staged>(bytes, std::move(names));
    if (!staged->memory.memory().empty())
        staged_ = std::move(staged);
}

void Pool::upload(uint64_t offset, std::span<const uvec4> page, uint32_t first_unit) const {
    if (page.empty())
        return;
    const uint32_t buffer = layout_.buffer_of(offset);
    const uint64_t inside = offset - layout_.begin_of(buffer);
    assert(buffer < buffers_.size() && inside + page.size_bytes() <= buffers_[buffer].bytes());
    if (staged_ && page.size_bytes() <= staged_->ring.max_bytes()) {
        staged_->ring.write(page.size_bytes(), buffer, inside, [&](std::span<std::byte> memory) {
            auto* const units = reinterpret_cast<uvec4*>(memory.data());
            copy_relocated(page, first_unit, {units, page.size()});
        });
        return;
    }
    void* const to = glMapNamedBufferRange(buffers_[buffer].id(), GLintptr(inside),
                                           GLsizeiptr(page.size_bytes()),
                                           GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT);
    if (!to)
        return; // the context is lost; GlThread notices that
    copy_relocated(page, first_unit, {static_cast<uvec4*>(to), page.size()});
    glUnmapNamedBuffer(buffers_[buffer].id());
}

void Pool::write(uint64_t offset, uint32_t word) const {
    const uint32_t buffer = layout_.buffer_of(offset);
    assert(buffer < buffers_.size());
    glNamedBufferSubData(buffers_[buffer].id(), GLintptr(offset - layout_.begin_of(buffer)),
                         sizeof(word), &word);
}

void Pool::bind(TexelReads reads) const {
    for (size_t i = 0; i < texels_.size(); ++i)
        texels_[i].bind(OVC_BINDING_POOL + GLuint(i), reads);
}

} // namespace ovc
