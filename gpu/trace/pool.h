// SPDX-License-Identifier: Apache-2.0
// Pool: the fixed number of GPU bytes that pages live in. It consists of as many buffers as it
// takes, allocated once and filled page by page. No page lies in two buffers.
#pragma once

#include "gpu/gl/gl_object.h"
#include "gpu/page/residency.h"
#include "gpu/trace/uploads.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// The buffers and their Residency. All calls need the context current.
class Pool {
public:
    /// Pages lie behind the first `begin` bytes, which the top-level tree takes. The ledger and the
    /// uploads outlive the pool.
    Pool(Ledger& ledger, const Uploads& uploads, const PoolLayout& layout, size_t leaves,
         uint64_t begin = 0);

    Residency& residency() { return residency_; }
    const Residency& residency() const { return residency_; }
    const PoolLayout& layout() const { return layout_; }
    /// Returns the offset before which no page lies.
    uint64_t begin() const { return begin_; }

    /// Makes the buffers readable by kernels. To be called once they are allocated.
    void show();

    /// Writes the units of a page at `offset`, in bytes, counted from `first_unit` on.
    void upload(uint64_t offset, std::span<const uvec4> page, uint32_t first_unit = 0) const;

    /// Writes a word at `offset`, in bytes.
    void write(uint64_t offset, uint32_t word) const;

    /// Binds all buffers for a kernel to read.
    void bind(TexelReads reads) const;

private:
    const Uploads& uploads_;
    PoolLayout layout_;
    uint64_t begin_;
    std::vector<gl::Buffer> buffers_;
    std::vector<gl::BufferTexture> texels_;
    Residency residency_;
};

} // namespace ovc
