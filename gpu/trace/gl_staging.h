// SPDX-License-Identifier: Apache-2.0
// GlStaging: the driver's side of a StagingRing in GL: memory of the driver that stays mapped, and
// fences. It is no GPU memory, and does not count for a budget.
#pragma once

#include "gpu/gl/fence.h"
#include "gpu/gl/mapped_buffer.h"
#include "gpu/trace/staging.h"

#include <deque>
#include <span>

namespace ovc {

/// Copies go to buffers by their GL names.
class GlStaging final : public StagingDriver {
public:
    /// The context is current, here and in all calls.
    explicit GlStaging(size_t bytes);
    GlStaging(const GlStaging&) = delete;

    std::span<std::byte> memory() override { return memory_; }
    void copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) override;
    uint64_t fence() override;
    void wait(uint64_t fence) override;

private:
    gl::MappedBuffer buffer_;
    std::span<std::byte> memory_;
    std::deque<gl::Fence> fences_; // the first has the number passed_ + 1
    uint64_t passed_ = 0;
};

} // namespace ovc
