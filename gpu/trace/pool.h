// SPDX-License-Identifier: Apache-2.0
// Pool: the fixed number of GPU bytes that pages live in. It consists of as many buffers as it
// takes, allocated once and filled page by page. No page lies in two buffers.
#pragma once

#include "gpu/gl/gl_object.h"
#include "gpu/page/residency.h"
#include "gpu/trace/gl_staging.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace ovc {

/// The buffers and their Residency. All calls need the context current.
class Pool {
public:
    /// Pages lie behind the first `begin` bytes, which the top-level tree takes.
    Pool(Ledger& ledger, const PoolLayout& layout, size_t leaves, uint64_t begin = 0);

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
    /// Pages go through it to buffers of the driver's own, so that writing one waits for no pass.
    struct Staged {
        GlStaging memory;
        StagingRing ring;

        Staged(size_t bytes, std::vector<GLuint> buffers)
            : memory(bytes, std::move(buffers)), ring(memory) {}
    };
    void stage();

    PoolLayout layout_;
    uint64_t begin_;
    bool takes_host_pages_;
    std::vector<gl::Buffer> buffers_;
    std::vector<gl::BufferTexture> texels_;
    std::unique_ptr<Staged> staged_; // null: pages are written to the buffers themselves
    Residency residency_;
};

} // namespace ovc
