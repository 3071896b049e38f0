// SPDX-License-Identifier: Apache-2.0
// Pool: writes pages and words to its buffers.
#include "gpu/trace/pool.h"

#include "gpu/page/top_level.h"

#include <cassert>

namespace ovc {

Pool::Pool(Ledger& ledger, const Uploads& uploads, const PoolLayout& layout, size_t leaves,
           uint64_t begin)
    : uploads_(uploads),
      layout_(layout),
      begin_(begin),
      residency_(stretches_of(layout, begin), OVC_UNIT_BYTES, leaves) {
    for (uint32_t i = 0; i < layout.count(); ++i)
        buffers_.emplace_back(ledger, layout.bytes_of(i), "page pool");
}

void Pool::show() {
    for (const gl::Buffer& buffer : buffers_)
        texels_.emplace_back().show(buffer, GL_RGBA32UI, 0, buffer.bytes());
}

void Pool::upload(uint64_t offset, std::span<const uvec4> page, uint32_t first_unit) const {
    const uint32_t buffer = layout_.buffer_of(offset);
    assert(buffer < buffers_.size());
    uploads_.write(buffers_[buffer], offset - layout_.begin_of(buffer), page.size_bytes(),
                   [&](std::span<std::byte> memory) {
                       auto* const units = reinterpret_cast<uvec4*>(memory.data());
                       copy_relocated(page, first_unit, {units, page.size()});
                   });
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
