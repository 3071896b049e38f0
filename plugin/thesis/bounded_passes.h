// SPDX-License-Identifier: Apache-2.0
// BoundedPasses: draws passes of a bounded number of steps until every ray has ended. GPUs of 2006
// needed that, because their fragment programs could not run for long. Based on: thesis, section
// 3.1 (render to texture, occlusion queries, early z-culling).
#pragma once

#include "gpu/gl/gl_object.h"

#include <array>
#include <cstdint>

namespace ovc::thesis {

/// Keeps where each ray stands in two sets of textures: a pass reads one and writes the other. A
/// depth texture keeps rays that have ended out of the next pass. All calls need the context
/// current; the ledger and `answers` must outlive this.
class BoundedPasses {
public:
    BoundedPasses(Ledger& ledger, const gl::Texture2D& answers, uint32_t width, uint32_t rows);

    bool complete() const;

    /// Draws over the first `rows` rows with `kernel` until no ray is left. `retire` is a program
    /// that discards rays still under way, so that an occlusion query counts those that have ended.
    /// Returns how many passes that took.
    uint64_t run(GLuint kernel, GLuint retire, uint32_t rows) const;

    static constexpr uint64_t kBytesPerRay = 2 * 3 * 16 + 4;

private:
    static constexpr int kSteps = 128; // per pass: fewer cost more passes, more gain nothing

    struct State {
        std::array<gl::Texture2D, 3> textures;
        gl::Framebuffer framebuffer;
    };
    State make_state(Ledger& ledger, const gl::Texture2D& answers) const;
    uint64_t retired_since(GLuint retire, const State& state) const;

    uint32_t width_;
    uint32_t rows_;
    gl::Texture2D depth_;
    std::array<State, 2> states_;
    gl::Framebuffer depth_only_;
    gl::OcclusionQuery query_;
};

} // namespace ovc::thesis
