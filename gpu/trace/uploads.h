// SPDX-License-Identifier: Apache-2.0
// Uploads: how pages and rays come to the buffers that kernels read.
#pragma once

#include "core/function_ref.h"
#include "gpu/gl/gl_object.h"
#include "gpu/trace/gl_staging.h"
#include "gpu/trace/staging.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace ovc {

/// All calls need the context current.
class Uploads {
public:
    /// behind_passes: writing waits for no pass that is under way, because everything goes through
    /// a ring of at most ring_bytes, from which the driver copies it. Else buffers are written in
    /// place.
    Uploads(bool behind_passes, uint64_t ring_bytes);

    /// Calls fill(memory for so many bytes), which go to the buffer from `to` on.
    void write(const gl::Buffer& buffer, uint64_t to, uint64_t bytes,
               FunctionRef<void(std::span<std::byte>)> fill) const;

    /// Copies the bytes to the begin of the buffer.
    void copy(std::span<const std::byte> bytes, const gl::Buffer& buffer) const;

    /// The max bytes of one write that do not have to be written in place.
    uint64_t max_bytes() const { return staged_ ? staged_->ring.max_bytes() : ~uint64_t(0); }

private:
    struct Staged {
        GlStaging memory;
        StagingRing ring;

        explicit Staged(size_t bytes) : memory(bytes), ring(memory) {}
    };

    std::unique_ptr<Staged> staged_; // null: buffers are written in place
};

} // namespace ovc
