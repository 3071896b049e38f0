// SPDX-License-Identifier: Apache-2.0
// Reads answers from pixels, in tiles, and from words, in planes.
#include "gpu/trace/answers.h"

#include "core/system/parallel.h"

#include <algorithm>
#include <atomic>
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

void AnswerPixels::read(std::span<Answer> answers) {
    const uvec4* pixels = nullptr;
    if (read_back_) {
        pixels = reinterpret_cast<const uvec4*>(read_back_->bytes().data());
    } else {
        pixels_.resize(whole_blocks(answers.size()));
        read_pixels(pixels_.size() / OVC_ROW_RAYS, pixels_.data());
        pixels = pixels_.data();
    }
    parallel_for(answers.size(), kAnswerGrain, [&](size_t first, size_t last) {
        for (size_t ray = first; ray < last; ++ray) {
            const uvec4& p = pixels[pixel_of(ray)];
            answers[ray] = {{p.x, p.y, p.z}, p.w, p.z};
        }
    });
}

AnswerWords::AnswerWords(Ledger& ledger, uint32_t rays, bool copied_behind)
    : rays_(rays),
      buffer_(ledger, uint64_t(rays) * kAnswerBytes, "answers"),
      read_back_(read_back_for(rays, copied_behind)) {
    assert(rays == whole_blocks(rays));
    texture_.show(buffer_, GL_R32UI, 0, buffer_.bytes());
    // The plane stays like this while all pages are resident, because no answer names a leaf then.
    fill_plane(3, rays_, OVC_NO_LEAF);
}

void AnswerWords::fill_plane(int number, size_t rays, uint32_t word) const {
    assert(number >= 0 && size_t(number) < planes_.size() && rays <= rays_);
    glClearNamedBufferSubData(buffer_.id(), GL_R32UI, GLintptr(offset_of(number)),
                              GLsizeiptr(rays * sizeof(word)), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              &word);
}

void AnswerWords::dispatch(GLuint program, size_t rays, size_t group_rays) {
    glProgramUniform1i(program, OVC_LOCATION_PLANE, GLint(rays_));
    glBindImageTexture(OVC_BINDING_ANSWERS, texture_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
    const size_t all = whole_blocks(rays);
    fill_plane(0, all, OVC_MISS);
    glProgramUniform1i(program, OVC_LOCATION_RAYS, GLint(all));
    glDispatchCompute(GLuint((all + group_rays - 1) / group_rays), 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (!read_back_)
        return;
    for (int number = 0; number < int(planes_.size()); ++number)
        glCopyNamedBufferSubData(buffer_.id(), read_back_->id(), GLintptr(offset_of(number)),
                                 GLintptr(offset_of(number)), GLsizeiptr(all * sizeof(uint32_t)));
    read_back_->end_copies();
}

std::span<const uint32_t> AnswerWords::plane(int number, size_t first, size_t rays) {
    assert(number >= 0 && size_t(number) < planes_.size() && first + rays <= rays_);
    if (read_back_) {
        const std::byte* const words = read_back_->bytes().data() + offset_of(number, first);
        return {reinterpret_cast<const uint32_t*>(words), rays};
    }
    std::vector<uint32_t>& words = planes_[size_t(number)];
    words.resize(rays);
    glGetNamedBufferSubData(buffer_.id(), GLintptr(offset_of(number, first)),
                            GLsizeiptr(rays * sizeof(uint32_t)), words.data());
    return words;
}

void AnswerWords::read(std::span<Answer> answers, size_t first_ray) {
    const std::span<const uint32_t> names = plane(0, first_ray, answers.size());
    std::atomic<uint32_t> seen = 0;
    parallel_for(answers.size(), kAnswerGrain, [&](size_t first, size_t last) {
        uint32_t all = 0;
        for (size_t ray = first; ray < last; ++ray) {
            all |= names[ray];
            answers[ray] = {{OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_LEAF},
                            names[ray] & ~OVC_SAYS_MORE,
                            OVC_NO_LEAF};
        }
        seen |= all;
    });
    if ((seen & OVC_SAYS_MORE) == 0)
        return;
    const std::array more{plane(1, first_ray, answers.size()), plane(2, first_ray, answers.size()),
                          plane(3, first_ray, answers.size())};
    parallel_for(answers.size(), kAnswerGrain, [&](size_t first, size_t last) {
        for (size_t ray = first; ray < last; ++ray)
            if (names[ray] & OVC_SAYS_MORE) {
                answers[ray].words = {more[0][ray], more[1][ray], more[2][ray]};
                answers[ray].where = more[2][ray];
            }
    });
}

} // namespace ovc
