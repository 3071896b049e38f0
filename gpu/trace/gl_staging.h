// SPDX-License-Identifier: Apache-2.0
// GlStaging: the driver's side of a StagingRing in GL: memory of the driver that stays mapped, and
// fences. It is no GPU memory, and does not count for a budget.
#pragma once

#include "gpu/gl/gl.h"
#include "gpu/gl/gl_object.h"
#include "gpu/trace/staging.h"

#include <deque>
#include <span>
#include <vector>

namespace ovc {

class GlStaging final : public StagingDriver {
public:
    /// buffers: the GL names of those that copies go to, by their numbers. The context is current,
    /// here and in all calls.
    GlStaging(size_t bytes, std::vector<GLuint> buffers);
    ~GlStaging() override;
    GlStaging(const GlStaging&) = delete;

    std::span<std::byte> memory() override { return memory_; }
    void copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) override;
    uint64_t fence() override;
    void wait(uint64_t fence) override;

private:
    static GLuint create();

    /// Whether the context is the one that this was made in; its fences are gone with it.
    bool is_alive() const { return generation_ == gl::context_generation; }

    const uint32_t generation_ = gl::context_generation;
    std::vector<GLuint> buffers_;
    gl::Handle<gl::delete_buffer> buffer_;
    std::span<std::byte> memory_;
    std::deque<GLsync> fences_; // the first has the number passed_ + 1
    uint64_t passed_ = 0;
};

} // namespace ovc
