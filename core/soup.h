// SPDX-License-Identifier: Apache-2.0
// Soup: the scene as bare triangles, three positions each, in chunks of one mesh each.
#pragma once

#include "core/box.h"
#include "core/build_progress.h"
#include "core/file/stored_corners.h"
#include "core/ray.h"
#include "core/transform.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

using Triangle = std::array<dvec3, 3>;

/// Returns 0 for x within 2^-256, infinity for x beyond 2^256, and else x. So products of three
/// differences, which decide hits, neither overflow nor lose a bit to underflow
/// (docs/design/numerics.md, "What it covers").
inline double in_range(double x) {
    const double size = std::abs(x);
    if (size < 0x1p-256)
        return 0;
    return size > 0x1p256 ? std::numeric_limits<double>::infinity() : x;
}

/// The triangles of one mesh. Corner i of triangle p lies at origin + corners[3 p + i], added in
/// double; in an instance, the transform then moves that point. A chunk is move-only: it owns its
/// corners, or borrows them from a caller who keeps them alive and unchanged, or has them read when
/// a triangle is asked for.
class Chunk {
public:
    static Chunk owning(dvec3 origin, std::vector<vec3> corners);
    static Chunk owning_doubles(dvec3 origin, std::vector<dvec3> corners);
    static Chunk borrowing(dvec3 origin, std::span<const vec3> corners);
    static Chunk borrowing_doubles(dvec3 origin, std::span<const dvec3> corners);
    /// Returns a chunk of `size` triangles whose corners lie on a disk.
    static Chunk stored(dvec3 origin, const StoredCorners& corners, uint32_t size);
    /// Returns some triangles of a stored chunk, placed alike, in memory.
    Chunk read(uint32_t first, uint32_t count) const;
    /// Returns the same triangles once more, placed alike. They borrow this chunk's corners.
    Chunk instance() const;
    /// Returns the same triangles without the transform. They borrow this chunk's corners.
    Chunk unplaced() const;
    /// Equal for chunks of the same triangles, placed or not, and for no others.
    using MeshKey = std::array<uint64_t, 5>;
    MeshKey mesh_key() const;
    /// Moves the triangles from where they are now, which an earlier transform may have decided.
    void place(const Transform& transform);
    /// Puts the triangles where the transform takes the mesh, or where the mesh lies by itself,
    /// whatever placed them before.
    void place_anew(const std::optional<Transform>& transform);
    /// Does the same with the transform of another chunk, which has none afterwards. It takes no
    /// memory.
    void take_place(Chunk& other) noexcept;
    /// Gives triangle `first` and those behind it new corners, three each. The chunk owns corners
    /// of this kind, and its instances see the new ones too.
    void set_corners(uint32_t first, std::span<const vec3> corners);
    void set_corners(uint32_t first, std::span<const dvec3> corners);

    Chunk(Chunk&&) = default;
    Chunk& operator=(Chunk&&) = default;

    const dvec3& origin() const { return origin_; }
    /// Returns 3 x size() offsets of 12 bytes each; none where they are doubles or stored.
    std::span<const vec3> corners() const { return corners_; }
    /// Returns 3 x size() offsets of 24 bytes each; none where they are floats or stored.
    std::span<const dvec3> double_corners() const { return double_corners_; }
    /// Returns null where the corners lie in memory.
    const StoredCorners* stored_corners() const { return stored_; }
    /// Returns the mask of the mesh (core/sieve.h). 0, as at first: all rays see it.
    uint32_t mask() const { return mask_; }
    void set_mask(uint32_t mask) { mask_ = mask; }
    /// Whether the transform is to change often. Such a chunk is cut and packed by itself.
    bool moves() const { return moves_; }
    void set_moves() { moves_ = true; }
    bool owns_corners() const { return !owned_.empty() || !owned_doubles_.empty(); }
    /// Returns null where the chunk has no transform.
    const Transform* transform() const { return transform_.get(); }
    uint32_t size() const {
        return uint32_t((corners_.size() + double_corners_.size()) / 3) + stored_size_;
    }
    uint64_t owned_bytes() const {
        return owned_.capacity() * sizeof(vec3) + owned_doubles_.capacity() * sizeof(dvec3);
    }
    /// Takes the corners out of an owning chunk of floats, which is empty afterwards.
    std::vector<vec3> take_corners() {
        corners_ = {};
        return std::exchange(owned_, {});
    }

    Triangle triangle(uint32_t prim) const {
        assert(prim < size());
        if (!plain_) [[unlikely]]
            return placed_triangle(prim);
        const vec3* c = corners_.data() + size_t(prim) * 3;
        return {origin_ + dvec3(c[0]), origin_ + dvec3(c[1]), origin_ + dvec3(c[2])};
    }
    /// Writes the coordinates of triangle(), corner by corner and kStride apart.
    template <size_t kStride>
    void put_triangle(uint32_t prim, double* to) const {
        assert(prim < size());
        const size_t at = size_t(prim) * 3;
        if (plain_)
            put_corners<kStride>(corners_.data() + at, origin_, to);
        else if (!transform_ && !double_corners_.empty())
            put_corners<kStride>(double_corners_.data() + at, origin_, to, in_range);
        else
            put_corners<kStride>(placed_triangle(prim).data(), dvec3(0), to);
    }
    /// Returns the address that triangle() reads from; that of stored_corners() where there are
    /// any.
    const void* address_of(uint32_t prim) const {
        if (stored_)
            return stored_;
        return double_corners_.empty()
                   ? static_cast<const void*>(corners_.data() + size_t(prim) * 3)
                   : double_corners_.data() + size_t(prim) * 3;
    }

private:
    explicit Chunk(dvec3 origin);
    bool is_plain() const;
    bool has_whole_triangles() const;
    Triangle placed_triangle(uint32_t prim) const;
    Triangle offsets(uint32_t prim) const;
    template <size_t kStride, class Vec, class Finish = std::identity>
    static void put_corners(const Vec* corners, const dvec3& origin, double* to,
                            Finish finish = {}) {
        const double x = origin.x, y = origin.y, z = origin.z;
        for (size_t i = 0; i < 3; ++i) {
            to[3 * i * kStride] = finish(x + double(corners[i].x));
            to[(3 * i + 1) * kStride] = finish(y + double(corners[i].y));
            to[(3 * i + 2) * kStride] = finish(z + double(corners[i].z));
        }
    }

    dvec3 origin_;
    std::vector<vec3> owned_; // its heap block survives a move, so corners_ may point into it
    std::vector<dvec3> owned_doubles_;
    std::span<const vec3> corners_; // empty where the corners are doubles
    std::span<const dvec3> double_corners_;
    const StoredCorners* stored_ = nullptr;
    uint32_t stored_size_ = 0;
    std::unique_ptr<const Transform> transform_;
    bool plain_; // floats without a transform, which the origin keeps in range
    bool moves_ = false;
    uint32_t mask_ = 0;
};

/// Calls visit(triangle) for the triangles [first, end) of a chunk, in order. Those that are stored
/// are read many at once.
template <class Visit>
void for_each_triangle(const Chunk& chunk, uint32_t first, uint32_t end, Visit&& visit) {
    constexpr uint32_t kAtOnce = 1024;
    if (!chunk.stored_corners()) {
        for (uint32_t prim = first; prim < end; ++prim)
            visit(chunk.triangle(prim));
        return;
    }
    for (; first < end; first += kAtOnce) {
        const uint32_t count = std::min(kAtOnce, end - first);
        const Chunk part = chunk.read(first, count);
        for (uint32_t i = 0; i < count; ++i)
            visit(part.triangle(i));
    }
}

/// Chunk m holds the triangles (m, 0) … (m, size - 1).
struct Soup {
    std::vector<Chunk> chunks;

    uint64_t triangle_count() const;
    bool has(TriangleId id) const {
        return id.mesh < chunks.size() && id.prim < chunks[id.mesh].size();
    }
    Triangle triangle(TriangleId id) const {
        assert(has(id));
        return chunks[id.mesh].triangle(id.prim);
    }
};

/// Why a triangle can never be hit.
enum class TriangleFault { None, NotFinite, Degenerate };

/// Returns NotFinite for a NaN or infinite corner, and Degenerate for corners on one line, which
/// have no area; that is decided exactly.
TriangleFault triangle_fault(const Triangle& triangle);

/// Counts the triangles that are left out of a structure, by reason.
struct Dropped {
    uint64_t not_finite = 0;
    uint64_t degenerate = 0;

    uint64_t total() const { return not_finite + degenerate; }
};

/// A look at some triangles: how many can never be hit, and the box of the others.
struct Survey {
    Dropped dropped;
    Box bounds;

    void add(const Survey& other);
};

/// Surveys triangles of a chunk from `first` on, as many as is_hit has elements, which are set to 1
/// for those that can be hit, else to 0. A triangle is a unit of progress.
Survey survey(const Chunk& chunk, uint32_t first, std::span<uint8_t> is_hit,
              BuildProgress* progress = nullptr);

/// Returns the ids of all triangles that can be hit, sorted. dropped, bounds: optional, receive how
/// many were left out and the box of the others. A triangle is a unit of progress.
std::vector<TriangleId> hittable_triangles(const Soup& soup, Dropped* dropped, Box* bounds,
                                           BuildProgress* progress = nullptr);

/// Does the same for some chunks alone, by their numbers, which rise.
std::vector<TriangleId> hittable_triangles(const Soup& soup, std::span<const uint32_t> chunks,
                                           Dropped* dropped, Box* bounds,
                                           BuildProgress* progress = nullptr);

inline Box bounds_of(const Triangle& t) {
    return {glm::min(glm::min(t[0], t[1]), t[2]), glm::max(glm::max(t[0], t[1]), t[2])};
}

} // namespace ovc
