// SPDX-License-Identifier: Apache-2.0
// The answers of a pass, and the buffers in which it leaves them: pixels of a texture (the fragment
// kernel) or words of a buffer (the compute kernel). shaders/layout.h defines their layouts.
#pragma once

#include "core/vec.h"
#include "gpu/gl/gl_object.h"
#include "gpu/trace/local_ray.h"
#include "gpu/trace/read_back.h"
#include "shaders/layout.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// The kernel's answer to a ray. prim: the number of a triangle, or OVC_MISS, OVC_FLAGGED,
/// OVC_CAPPED.
struct Answer {
    std::array<uint32_t, 3> words;
    uint32_t prim;
    /// The key of the link that the ray waits for; OVC_NO_LEAF if it waits for none.
    uint32_t where;
    /// The further candidates where there are more than two, or none.
    std::span<const uint32_t> listed{};

    /// Not OVC_FLAGGED: triangles that may be the answer as well, two or more;
    /// OVC_NO_TRIANGLE in the place of those that there are not.
    std::span<const uint32_t> further() const {
        return listed.empty() ? std::span(words).first(2) : listed;
    }
    bool has_further() const { return words[0] != OVC_NO_TRIANGLE; }
    /// OVC_FLAGGED: a t in the tree's frame, before which nothing is hit.
    float first_t() const { return std::bit_cast<float>(words[1]); }
};

/// The answers of a pass, in planes as the compute kernel writes them. Most say no more than a
/// name.
struct Answers {
    std::vector<uint32_t> names;               // prim, with OVC_SAYS_MORE where `more` counts
    std::array<std::vector<uint32_t>, 3> more; // x, y, z
    std::vector<uvec4> lists;                  // the rays, as far as any have names in their places
    size_t ray_texels = 0;                     // of one of them

    Answer operator[](size_t i) const {
        const uint32_t prim = names[i] & ~OVC_SAYS_MORE;
        if (prim == names[i])
            return {{OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_LEAF}, prim, OVC_NO_LEAF};
        Answer answer{{more[0][i], more[1][i], more[2][i]}, prim, more[2][i]};
        if (is_listed(i))
            answer.listed = list_at(answer.words[1]);
        return answer;
    }
    /// Whether the answer's candidates are named in the place of a ray.
    bool is_listed(size_t i) const {
        return (names[i] & OVC_SAYS_MORE) && more[0][i] == OVC_LISTED;
    }
    /// Gives ray i the answer of slot `from`.
    void move(size_t i, size_t from) {
        names[i] = names[from];
        if (names[i] & OVC_SAYS_MORE)
            for (std::vector<uint32_t>& plane : more)
                plane[i] = plane[from];
    }

private:
    std::span<const uint32_t> list_at(uint32_t word) const {
        return {&lists[(word >> OVC_LIST_BITS) * ray_texels].x, word & ((1u << OVC_LIST_BITS) - 1)};
    }
};

/// Bytes of an answer on the GPU.
inline constexpr uint64_t kAnswerBytes = 16;
/// Bytes of the counter by which subgroups claim their rays, behind the answers of a pass.
inline constexpr uint64_t kCounterBytes = 4;

/// The leaf that the key of a link names.
inline uint32_t leaf_of(uint32_t key) {
    return (key & OVC_KEY_LEAF) - 1;
}

/// Rays are traced in blocks of this size: a row of tiles.
inline constexpr uint32_t kBlockRays = OVC_ROW_RAYS * OVC_TILE;
/// Returns n rounded up to whole blocks: the size that a buffer for n rays must have.
inline size_t whole_blocks(size_t n) {
    return (n + kBlockRays - 1) / kBlockRays * kBlockRays;
}

/// Answers of the fragment kernel. This class and AnswerWords have room for `rays` rays, whole
/// blocks. draw() and dispatch() start the pass: its program is in use and its inputs are bound.
/// begin_read(), called next, has the answers copied behind the pass, where that is wanted. read()
/// waits for the pass, and not for later ones if the answers are copied behind it.
class AnswerPixels {
public:
    AnswerPixels(Ledger& ledger, uint32_t rays, bool copied_behind);
    /// False where the driver cannot draw to such a texture.
    bool complete() const { return framebuffer_.complete(); }
    void draw(size_t rays);
    void begin_read(size_t rays);
    /// Reads the answers of the first rays.
    void read(Answers& answers, size_t rays);

private:
    void read_pixels(size_t rows, void* to) const;

    gl::Texture2D texture_;
    gl::Framebuffer framebuffer_;
    gl::VertexArray vertex_array_;
    std::vector<uvec4> pixels_;
    std::optional<ReadBack> read_back_;
};

/// Answers of the compute kernel. It writes no misses, so dispatch() first fills them in.
class AnswerWords {
public:
    AnswerWords(Ledger& ledger, uint32_t rays, bool copied_behind);
    /// group_rays: of a work group, on average. lane_rays: that a subgroup claims for each of its
    /// lanes at a time; 0: it claims none.
    void dispatch(GLuint program, size_t rays, size_t group_rays, size_t lane_rays);
    /// may_wait: rays may wait for pages, so their answers may name leaves.
    void begin_read(size_t rays, bool may_wait);
    /// Reads the answers of the first slots.
    void read(Answers& answers, size_t slots);

private:
    uint64_t offset_of(int number) const { return uint64_t(number) * rays_ * sizeof(uint32_t); }
    void fill(uint64_t offset, size_t words, uint32_t word) const;
    void read_plane(int number, size_t slots, std::vector<uint32_t>& to) const;
    void read_copied(Answers& answers, size_t slots);

    uint32_t rays_;
    gl::Buffer buffer_;
    gl::BufferTexture texture_;
    std::optional<ReadBack> read_back_;
    bool tells_leaves_ = true; // else the kernel leaves the plane of leaves as it was
};

} // namespace ovc
