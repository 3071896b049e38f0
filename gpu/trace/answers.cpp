// SPDX-License-Identifier: Apache-2.0
// Reads answers from pixels, in tiles, and from words, in planes.
#include "gpu/trace/answers.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

constexpr size_t kAnswerGrain = 16384; // rays a task; a task only copies

/// Returns the pixel of a ray's answer, counted row by row: the counterpart of pixel_of() in
/// shaders/ray.glsl.
size_t pixel_of(size_t ray) {
    constexpr size_t kTile = OVC_TILE, kTilesInRow = OVC_ROW_RAYS / OVC_TILE;
    const size_t tile = ray / (kTile * kTile);
    const size_t x = tile % kTilesInRow * kTile + ray % kTile;
    const size_t y = tile / kTilesInRow * kTile + ray / kTile % kTile;
    return y * OVC_ROW_RAYS + x;
}

/// Returns memory for the answers of so many rays, or nothing where it is not wanted or not given.
std::optional<ReadBack> read_back_for(uint32_t rays, bool wanted) {
    std::optional<ReadBack> made;
    if (wanted)
        made.emplace(rays * kAnswerBytes);
    return made && made->is_there() ? std::move(made) : std::nullopt;
}

} // namespace

AnswerPixels::AnswerPixels(Ledger& ledger, uint32_t rays, bool copied_behind)
    : texture_(ledger, GL_RGBA32UI, kAnswerBytes, OVC_ROW_RAYS, rays / OVC_ROW_RAYS, "answers"),
      framebuffer_(texture_),
      read_back_(read_back_for(rays, copied_behind)) {}

void AnswerPixels::draw(size_t rays) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glBindVertexArray(vertex_array_.id());
    glViewport(0, 0, OVC_ROW_RAYS, GLsizei(whole_blocks(rays) / OVC_ROW_RAYS));
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void AnswerPixels::begin_read(size_t rays) {
    if (!read_back_)
        return;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, read_back_->id());
    read_pixels(whole_blocks(rays) / OVC_ROW_RAYS, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    read_back_->end_copies();
}

/// to: memory, or an offset into the buffer that is bound for pixels.
void AnswerPixels::read_pixels(size_t rows, void* to) const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glReadPixels(0, 0, OVC_ROW_RAYS, GLsizei(rows), GL_RGBA_INTEGER, GL_UNSIGNED_INT, to);
}

/// Makes room, and clears none of it.
static void grow(std::vector<uint32_t>& plane, size_t size) {
    plane.resize(std::max(plane.size(), size));
}

void AnswerPixels::read(Answers& answers, size_t rays) {
    const uvec4* pixels = nullptr;
    if (read_back_) {
        pixels = reinterpret_cast<const uvec4*>(read_back_->bytes().data());
    } else {
        pixels_.resize(whole_blocks(rays));
        read_pixels(pixels_.size() / OVC_ROW_RAYS, pixels_.data());
        pixels = pixels_.data();
    }
    grow(answers.names, rays);
    for (std::vector<uint32_t>& plane : answers.more)
        grow(plane, rays);
    parallel_for(rays, kAnswerGrain, [&](size_t first, size_t last) {
        for (size_t ray = first; ray < last; ++ray) {
            const uvec4& p = pixels[pixel_of(ray)];
            answers.names[ray] = p.w | OVC_SAYS_MORE;
            for (int k = 0; k < 3; ++k)
                answers.more[size_t(k)][ray] = p[k];
        }
    });
}

AnswerWords::AnswerWords(Ledger& ledger, uint32_t rays, bool copied_behind)
    : rays_(rays),
      buffer_(ledger, uint64_t(rays) * kAnswerBytes + kCounterBytes, "answers"),
      read_back_(read_back_for(rays, copied_behind)) {
    assert(rays == whole_blocks(rays));
    texture_.show(buffer_, GL_R32UI, 0, offset_of(4));
}

/// offset: in bytes.
void AnswerWords::fill(uint64_t offset, size_t words, uint32_t word) const {
    glClearNamedBufferSubData(buffer_.id(), GL_R32UI, GLintptr(offset),
                              GLsizeiptr(words * sizeof(word)), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              &word);
}

void AnswerWords::dispatch(GLuint program, size_t rays, size_t group_rays, size_t lane_rays) {
    glProgramUniform1i(program, OVC_LOCATION_PLANE, GLint(rays_));
    glBindImageTexture(OVC_BINDING_ANSWERS, texture_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
    const size_t all = whole_blocks(rays);
    fill(offset_of(0), all, OVC_MISS);
    glProgramUniform1i(program, OVC_LOCATION_RAYS, GLint(all));
    if (lane_rays > 0) {
        fill(offset_of(4), 1, 0);
        glBindBufferRange(GL_ATOMIC_COUNTER_BUFFER, OVC_BINDING_SHARES, buffer_.id(),
                          GLintptr(offset_of(4)), kCounterBytes);
        glProgramUniform1i(program, OVC_LOCATION_LANE_RAYS, GLint(lane_rays));
    }
    glDispatchCompute(GLuint((all + group_rays - 1) / group_rays), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

void AnswerWords::begin_read(size_t rays, bool may_wait) {
    tells_leaves_ = may_wait;
    if (!read_back_)
        return;
    const size_t all = whole_blocks(rays);
    for (int number = 0; number < (may_wait ? 4 : 3); ++number)
        glCopyNamedBufferSubData(buffer_.id(), read_back_->id(), GLintptr(offset_of(number)),
                                 GLintptr(offset_of(number)), GLsizeiptr(all * sizeof(uint32_t)));
    read_back_->end_copies();
}

void AnswerWords::read_plane(int number, size_t slots, std::vector<uint32_t>& to) const {
    assert(number >= 0 && number < 4 && slots <= rays_);
    grow(to, slots);
    glGetNamedBufferSubData(buffer_.id(), GLintptr(offset_of(number)),
                            GLsizeiptr(slots * sizeof(uint32_t)), to.data());
}

void AnswerWords::read(Answers& answers, size_t slots) {
    if (read_back_) {
        read_copied(answers, slots);
        return;
    }
    read_plane(0, slots, answers.names);
    uint32_t all = 0;
    for (size_t i = 0; i < slots; ++i)
        all |= answers.names[i];
    if (!(all & OVC_SAYS_MORE))
        return;
    for (int k = 0; k < 2; ++k)
        read_plane(1 + k, slots, answers.more[size_t(k)]);
    if (tells_leaves_)
        read_plane(3, slots, answers.more[2]);
    else
        answers.more[2].assign(slots, OVC_NO_LEAF);
}

/// Reads what was copied behind the pass; of `more` only where any answer of a task says so.
void AnswerWords::read_copied(Answers& answers, size_t slots) {
    grow(answers.names, slots);
    for (std::vector<uint32_t>& plane : answers.more)
        grow(plane, slots);
    const auto* const words = reinterpret_cast<const uint32_t*>(read_back_->bytes().data());
    parallel_for(slots, kAnswerGrain, [&](size_t first, size_t last) {
        const auto copy = [&](int number, std::vector<uint32_t>& to) {
            std::copy(words + size_t(number) * rays_ + first, words + size_t(number) * rays_ + last,
                      to.begin() + ptrdiff_t(first));
        };
        copy(0, answers.names);
        uint32_t all = 0;
        for (size_t i = first; i < last; ++i)
            all |= answers.names[i];
        if (!(all & OVC_SAYS_MORE))
            return;
        copy(1, answers.more[0]);
        copy(2, answers.more[1]);
        if (tells_leaves_)
            copy(3, answers.more[2]);
        else
            std::fill(answers.more[2].begin() + ptrdiff_t(first),
                      answers.more[2].begin() + ptrdiff_t(last), uint32_t(OVC_NO_LEAF));
    });
}

} // namespace ovc
