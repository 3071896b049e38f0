// SPDX-License-Identifier: Apache-2.0
// Soup: who owns the corners of a chunk, and which triangles can be hit.
#include "core/soup.h"

#include "core/exact/exact.h"
#include "core/system/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace ovc {

namespace {

/// Returns whether each sum with a float is in range: a multiple of 2^-201, less than 2^256.
bool keeps_floats_in_range(double origin) {
    const double size = std::abs(origin);
    return size == 0 || (size >= 0x1p-149 && size <= 0x1p255);
}

} // namespace

Chunk::Chunk(dvec3 origin) : origin_(origin), plain_(is_plain()) {}

bool Chunk::is_plain() const {
    return !transform_ && !stored_ && double_corners_.empty() && keeps_floats_in_range(origin_.x) &&
           keeps_floats_in_range(origin_.y) && keeps_floats_in_range(origin_.z);
}

Chunk Chunk::owning(dvec3 origin, std::vector<vec3> corners) {
    Chunk chunk(origin);
    chunk.owned_ = std::move(corners);
    chunk.corners_ = chunk.owned_;
    assert(chunk.has_whole_triangles());
    return chunk;
}

Chunk Chunk::owning_doubles(dvec3 origin, std::vector<dvec3> corners) {
    Chunk chunk = borrowing_doubles(origin, corners);
    chunk.owned_doubles_ = std::move(corners);
    return chunk;
}

Chunk Chunk::borrowing(dvec3 origin, std::span<const vec3> corners) {
    Chunk chunk(origin);
    chunk.corners_ = corners;
    assert(chunk.has_whole_triangles());
    return chunk;
}

Chunk Chunk::borrowing_doubles(dvec3 origin, std::span<const dvec3> corners) {
    Chunk chunk(origin);
    chunk.double_corners_ = corners;
    chunk.plain_ = false;
    assert(chunk.has_whole_triangles());
    return chunk;
}

Chunk Chunk::stored(dvec3 origin, const StoredCorners& corners, uint32_t size) {
    Chunk chunk(origin);
    chunk.stored_ = &corners;
    chunk.stored_size_ = size;
    chunk.plain_ = false;
    return chunk;
}

Chunk Chunk::read(uint32_t first, uint32_t count) const {
    assert(stored_ && uint64_t(first) + count <= size());
    const auto corners = [&](auto corner) {
        std::vector<decltype(corner)> all(count * size_t(3));
        stored_->read(first, std::as_writable_bytes(std::span(all)));
        return all;
    };
    Chunk chunk = stored_->has_doubles() ? owning_doubles(origin_, corners(dvec3()))
                                         : owning(origin_, corners(vec3()));
    if (transform_)
        chunk.place(*transform_);
    return chunk;
}

Chunk Chunk::instance() const {
    Chunk chunk(origin_);
    chunk.corners_ = corners_;
    chunk.double_corners_ = double_corners_;
    chunk.stored_ = stored_;
    chunk.stored_size_ = stored_size_;
    chunk.plain_ = plain_;
    if (transform_)
        chunk.transform_ = std::make_unique<Transform>(*transform_);
    return chunk;
}

Chunk Chunk::unplaced() const {
    if (stored_)
        return stored(origin_, *stored_, stored_size_);
    return double_corners_.empty() ? borrowing(origin_, corners_)
                                   : borrowing_doubles(origin_, double_corners_);
}

Chunk::MeshKey Chunk::mesh_key() const {
    return {uint64_t(reinterpret_cast<uintptr_t>(address_of(0))),
            uint64_t(size()) << 1 | uint64_t(corners_.empty()), std::bit_cast<uint64_t>(origin_.x),
            std::bit_cast<uint64_t>(origin_.y), std::bit_cast<uint64_t>(origin_.z)};
}

void Chunk::place(const Transform& transform) {
    transform_ = std::make_unique<Transform>(transform_ ? then(*transform_, transform) : transform);
    plain_ = false;
}

void Chunk::place_anew(const std::optional<Transform>& transform) {
    transform_ = transform ? std::make_unique<Transform>(*transform) : nullptr;
    plain_ = is_plain();
}

void Chunk::take_place(Chunk& other) noexcept {
    transform_ = std::move(other.transform_);
    plain_ = is_plain();
}

void Chunk::set_corners(uint32_t first, std::span<const vec3> corners) {
    assert(first * size_t(3) + corners.size() <= owned_.size());
    std::ranges::copy(corners, owned_.begin() + ptrdiff_t(first) * 3);
}

void Chunk::set_corners(uint32_t first, std::span<const dvec3> corners) {
    assert(first * size_t(3) + corners.size() <= owned_doubles_.size());
    std::ranges::copy(corners, owned_doubles_.begin() + ptrdiff_t(first) * 3);
}

bool Chunk::has_whole_triangles() const {
    const size_t count = corners_.size() + double_corners_.size();
    return count % 3 == 0 && count / 3 < kNone;
}

Triangle Chunk::offsets(uint32_t prim) const {
    const auto three = [](const auto* c) {
        return Triangle{dvec3(c[0]), dvec3(c[1]), dvec3(c[2])};
    };
    const auto read = [&](auto corners) {
        stored_->read(prim, std::as_writable_bytes(std::span(corners)));
        return three(corners.data());
    };
    if (stored_)
        return stored_->has_doubles() ? read(std::array<dvec3, 3>()) : read(std::array<vec3, 3>());
    const size_t at = size_t(prim) * 3;
    return corners_.empty() ? three(&double_corners_[at]) : three(&corners_[at]);
}

Triangle Chunk::placed_triangle(uint32_t prim) const {
    Triangle triangle = offsets(prim);
    for (dvec3& offset : triangle) {
        const dvec3 p = transform_ ? (*transform_)(origin_ + offset) : origin_ + offset;
        offset = {in_range(p.x), in_range(p.y), in_range(p.z)};
    }
    return triangle;
}

uint64_t Soup::triangle_count() const {
    uint64_t count = 0;
    for (const Chunk& chunk : chunks)
        count += chunk.size();
    return count;
}

static bool on_a_line(const Triangle& t) {
    constexpr double v = 0x1p-53;
    const dvec3 ab = t[1] - t[0], ac = t[2] - t[0];
    for (int axis = 0; axis < 3; ++axis) {
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        const double left = ab[j] * ac[k], right = ab[k] * ac[j];
        // Each side rounds in two differences and a product, and their difference rounds once more.
        const double error = 5 * v * (std::abs(left) + std::abs(right)) + 0x1p-1060;
        if (std::abs(left - right) > error)
            return false;
    }
    const Vec3Of<Exact> a = exact(t[0]);
    const Vec3Of<Exact> normal = cross(exact(t[1]) - a, exact(t[2]) - a);
    return normal.x.sign() == 0 && normal.y.sign() == 0 && normal.z.sign() == 0;
}

TriangleFault triangle_fault(const Triangle& t) {
    if (!is_finite(t[0]) || !is_finite(t[1]) || !is_finite(t[2]))
        return TriangleFault::NotFinite;
    return on_a_line(t) ? TriangleFault::Degenerate : TriangleFault::None;
}

void Survey::add(const Survey& other) {
    dropped.not_finite += other.dropped.not_finite;
    dropped.degenerate += other.dropped.degenerate;
    bounds.add(other.bounds);
}

Survey survey(const Chunk& chunk, uint32_t first, std::span<uint8_t> is_hit,
              BuildProgress* progress) {
    assert(first + is_hit.size() <= chunk.size());
    return parallel_reduce(
        is_hit.size(), Survey{},
        [&](size_t from, size_t to, Survey found) {
            LoopProgress loop(progress);
            for (size_t i = from; i < to; ++i, loop.step()) {
                const Triangle triangle = chunk.triangle(first + uint32_t(i));
                const TriangleFault fault = triangle_fault(triangle);
                is_hit[i] = fault == TriangleFault::None;
                found.dropped.not_finite += fault == TriangleFault::NotFinite;
                found.dropped.degenerate += fault == TriangleFault::Degenerate;
                if (fault == TriangleFault::None)
                    found.bounds.add(bounds_of(triangle));
            }
            loop.finish();
            return found;
        },
        [](Survey a, const Survey& b) {
            a.add(b);
            return a;
        });
}

std::vector<TriangleId> hittable_triangles(const Soup& soup, Dropped* dropped, Box* bounds,
                                           BuildProgress* progress) {
    std::vector<uint32_t> all(soup.chunks.size());
    std::iota(all.begin(), all.end(), 0u);
    return hittable_triangles(soup, all, dropped, bounds, progress);
}

std::vector<TriangleId> hittable_triangles(const Soup& soup, std::span<const uint32_t> chunks,
                                           Dropped* dropped, Box* bounds, BuildProgress* progress) {
    assert(std::is_sorted(chunks.begin(), chunks.end()));
    std::vector<TriangleId> ids;
    Survey total;
    std::vector<uint8_t> kept;
    size_t count = 0;
    for (const uint32_t mesh : chunks)
        count += soup.chunks[mesh].size();
    ids.reserve(count);
    for (const uint32_t mesh : chunks) {
        const Chunk& chunk = soup.chunks[mesh];
        kept.assign(chunk.size(), 0);
        total.add(survey(chunk, 0, kept, progress));
        for (uint32_t prim = 0; prim < chunk.size(); ++prim)
            if (kept[prim])
                ids.push_back({mesh, prim});
    }
    if (dropped)
        *dropped = total.dropped;
    if (bounds)
        *bounds = total.bounds;
    return ids;
}

} // namespace ovc
