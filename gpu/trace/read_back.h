// SPDX-License-Identifier: Apache-2.0
// ReadBack: memory that stays mapped, into which the device copies answers behind a pass, so that
// this process reads them without waiting for what it asked of the device since.
#pragma once

#include "gpu/gl/fence.h"
#include "gpu/gl/mapped_buffer.h"

#include <cstddef>
#include <optional>
#include <span>

namespace ovc {

/// All calls need the context current.
class ReadBack {
public:
    explicit ReadBack(size_t bytes) : buffer_(bytes, GL_MAP_READ_BIT) {}

    /// False where the driver gives no such memory.
    bool is_there() const { return !buffer_.memory().empty(); }
    /// The GL name of the buffer to copy to.
    GLuint id() const { return buffer_.id(); }
    /// Must be called behind the copies of a pass.
    void end_copies() { copied_.emplace(); }
    /// Waits for these copies, and returns the memory.
    std::span<const std::byte> bytes() {
        if (copied_)
            copied_->wait();
        copied_.reset();
        return buffer_.memory();
    }

private:
    gl::MappedBuffer buffer_;
    std::optional<gl::Fence> copied_;
};

} // namespace ovc
