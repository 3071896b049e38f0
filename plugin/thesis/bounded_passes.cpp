// SPDX-License-Identifier: Apache-2.0
// BoundedPasses: ping-pong between textures, the depth test, the occlusion query.
#include "plugin/thesis/bounded_passes.h"

#include "shaders/layout.h"

#include <cassert>

namespace ovc::thesis {

BoundedPasses::State BoundedPasses::make_state(Ledger& ledger, const gl::Texture2D& answers) const {
    const auto texture = [&] {
        return gl::Texture2D(ledger, GL_RGBA32UI, 16, width_, rows_, "where rays stand");
    };
    State state{{texture(), texture(), texture()}, gl::Framebuffer(answers)};
    const GLuint id = state.framebuffer.id();
    for (GLuint i = 0; i < 3; ++i)
        glNamedFramebufferTexture(id, GL_COLOR_ATTACHMENT1 + i, state.textures[i].id(), 0);
    glNamedFramebufferTexture(id, GL_DEPTH_ATTACHMENT, depth_.id(), 0);
    constexpr std::array<GLenum, 4> targets = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                               GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3};
    glNamedFramebufferDrawBuffers(id, GLsizei(targets.size()), targets.data());
    return state;
}

BoundedPasses::BoundedPasses(Ledger& ledger, const gl::Texture2D& answers, uint32_t width,
                             uint32_t rows)
    : width_(width),
      rows_(rows),
      depth_(ledger, GL_DEPTH_COMPONENT32F, 4, width, rows, "rays that have ended"),
      states_{make_state(ledger, answers), make_state(ledger, answers)},
      depth_only_(answers) {
    glNamedFramebufferTexture(depth_only_.id(), GL_DEPTH_ATTACHMENT, depth_.id(), 0);
    glNamedFramebufferDrawBuffer(depth_only_.id(), GL_NONE);
}

bool BoundedPasses::complete() const {
    return states_[0].framebuffer.complete() && states_[1].framebuffer.complete() &&
           depth_only_.complete();
}

/// Returns how many rays have ended in `state` and not before, and marks them in depth_.
uint64_t BoundedPasses::retired_since(GLuint retire, const State& state) const {
    glUseProgram(retire);
    glBindFramebuffer(GL_FRAMEBUFFER, depth_only_.id());
    glBindTextureUnit(OVC_BINDING_STATE, state.textures[0].id());
    glDepthMask(GL_TRUE);
    glBeginQuery(GL_SAMPLES_PASSED, query_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glEndQuery(GL_SAMPLES_PASSED);
    glDepthMask(GL_FALSE);
    GLuint64 samples = 0;
    glGetQueryObjectui64v(query_.id(), GL_QUERY_RESULT, &samples);
    return samples;
}

uint64_t BoundedPasses::run(GLuint kernel, GLuint retire, uint32_t rows) const {
    assert(rows <= rows_);
    constexpr GLfloat far = 1;
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(depth_only_.id(), GL_DEPTH, 0, &far);
    glDepthMask(GL_FALSE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS); // all is drawn at one depth, so a written pixel fails
    uint64_t passes = 0;
    for (uint64_t left = uint64_t(width_) * rows; left > 0; ++passes) {
        const State& from = states_[passes % 2];
        const State& to = states_[(passes + 1) % 2];
        glUseProgram(kernel);
        glUniform1i(0, kSteps);
        glUniform1i(1, passes == 0);
        glBindFramebuffer(GL_FRAMEBUFFER, to.framebuffer.id());
        for (GLuint i = 0; i < 3; ++i)
            glBindTextureUnit(OVC_BINDING_STATE + i, from.textures[i].id());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        const uint64_t retired = retired_since(retire, to);
        left -= retired < left ? retired : left;
    }
    glDisable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    return passes;
}

} // namespace ovc::thesis
