// SPDX-License-Identifier: Apache-2.0
// Chunks by the corners that they borrow, and what a placement does to them.
#include "plugin/shared_meshes.h"

#include "gpu/top_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace ovc {
namespace {

/// A page's bytes for a triangle, about.
constexpr uint64_t kBytesPerTriangle = 46;
/// Bytes are worth a portal's time if there are so many times more of them.
constexpr uint64_t kWorthAPortal = 4;

using Rows = std::array<std::array<double, 4>, 3>;
constexpr Rows kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

const Rows& rows_of(const Placement* placement) {
    return placement ? placement->rows : kIdentity;
}

/// The inverse of the matrix of a placement, without its shift; nothing where there is none.
std::optional<std::array<dvec3, 3>> inverse(const Rows& m) {
    const auto row = [&](size_t i) { return dvec3(m[i][0], m[i][1], m[i][2]); };
    const dvec3 a = glm::cross(row(1), row(2)), b = glm::cross(row(2), row(0)),
                c = glm::cross(row(0), row(1));
    const double determinant = glm::dot(row(0), a);
    if (!(std::abs(determinant) >= 0x1p-500 && std::abs(determinant) <= 0x1p500))
        return std::nullopt;
    std::array<dvec3, 3> rows;
    for (int i = 0; i < 3; ++i)
        rows[size_t(i)] = dvec3(a[i], b[i], c[i]) / determinant;
    return rows;
}

/// The box of a mesh before it is placed; empty where a corner is not finite.
Box bounds_of(const Chunk& mesh) {
    Box box;
    for (uint32_t prim = 0; prim < mesh.size(); ++prim)
        for (const dvec3& corner : mesh.triangle(prim)) {
            if (!is_finite(corner))
                return {};
            box.add(corner);
        }
    return box;
}

/// Whether what doubles round of corners that are placed, and of rays that are brought to the mesh,
/// is less than 2^-30 of it: 1/64 of what float32 rounds there. With one more bit to spare.
bool is_well_placed(const Box& box, const Placement* placement) {
    constexpr double kFarthest = 0x1p19;    // in sizes of the mesh
    constexpr double kWithinRange = 0x1p80; // no product of three is out of range
    const Rows& m = rows_of(placement);
    const auto inverted = inverse(m);
    const double size = max_component(box.extent()) / 2;
    if (!inverted || box.empty() || !(size >= 1 / kWithinRange))
        return false;
    const dvec3 farthest = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    dvec3 reach; // of placed corners, and of what their sums are made of
    for (int i = 0; i < 3; ++i) {
        const auto& r = m[size_t(i)];
        reach[i] = std::abs(r[0]) * farthest.x + std::abs(r[1]) * farthest.y +
                   std::abs(r[2]) * farthest.z + std::abs(r[3]);
    }
    double most = 0;
    for (const dvec3& row : *inverted)
        most = std::max(most, glm::dot(glm::abs(row), reach));
    return most <= kFarthest * size && max_component(reach) <= kWithinRange;
}

/// Chunks of the same mesh, in the order of their numbers, by their first.
std::vector<std::vector<uint32_t>> by_mesh(const Soup& soup) {
    using Key = std::tuple<const void*, const void*, uint32_t, double, double, double>;
    std::map<Key, size_t> found;
    std::vector<std::vector<uint32_t>> meshes;
    for (uint32_t i = 0; i < soup.chunks.size(); ++i) {
        const Chunk& chunk = soup.chunks[i];
        if (chunk.size() == 0)
            continue;
        const dvec3& at = chunk.origin();
        const Key key{
            chunk.corners().data(), chunk.double_corners().data(), chunk.size(), at.x, at.y, at.z};
        const auto [place, is_new] = found.try_emplace(key, meshes.size());
        if (is_new)
            meshes.emplace_back();
        meshes[place->second].push_back(i);
    }
    return meshes;
}

/// Takes out those that lie where one before does.
void take_copies_out(const Soup& soup, std::vector<uint32_t>& chunks, Placed& placed) {
    std::map<Rows, Placed::Copies> places;
    std::vector<uint32_t> apart;
    for (const uint32_t chunk : chunks) {
        const auto [place, is_new] = places.try_emplace(rows_of(soup.chunks[chunk].placement()),
                                                        Placed::Copies{chunk, chunk, 0});
        Placed::Copies& copies = place->second;
        if (is_new)
            apart.push_back(chunk);
        if (++copies.count == 2)
            copies.second = chunk;
    }
    for (const auto& [rows, copies] : places)
        if (copies.count > 1)
            placed.copies.push_back(copies);
    chunks = std::move(apart);
}

} // namespace

Placed placed_chunks(const Soup& soup) {
    Placed placed;
    for (std::vector<uint32_t>& chunks : by_mesh(soup)) {
        if (chunks.size() > 1)
            take_copies_out(soup, chunks, placed);
        const Chunk& mesh = soup.chunks[chunks.front()];
        const uint64_t saved = (chunks.size() - 1) * kBytesPerTriangle * mesh.size();
        std::vector<uint32_t> shared;
        if (saved > kWorthAPortal * kMaxBytesPerPart * chunks.size()) {
            const Box box = bounds_of(mesh.unplaced());
            for (const uint32_t chunk : chunks)
                (is_well_placed(box, soup.chunks[chunk].placement()) ? shared : placed.once)
                    .push_back(chunk);
        } else {
            placed.once.insert(placed.once.end(), chunks.begin(), chunks.end());
        }
        if (shared.size() > 1)
            placed.shared.push_back(std::move(shared));
        else
            placed.once.insert(placed.once.end(), shared.begin(), shared.end());
    }
    std::ranges::sort(placed.once);
    std::ranges::sort(placed.copies, {}, &Placed::Copies::first);
    return placed;
}

uint64_t unique_triangles(const Soup& soup, const Placed& placed) {
    uint64_t count = 0;
    for (const uint32_t chunk : placed.once)
        count += soup.chunks[chunk].size();
    for (const Placed::Instances& instances : placed.shared)
        count += soup.chunks[instances.front()].size();
    return count;
}

Box placed_box(const Box& box, const Placement* placement) {
    Box placed;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                      corner & 4 ? box.hi.z : box.lo.z);
        placed.add(placement ? (*placement)(p) : p);
    }
    return placed.padded(placed.rounding());
}

Portal portal_into(const Frame& frame, const Box& box, const Placement* placement) {
    Portal portal = portal_into(frame, box);
    if (!placement)
        return portal;
    const auto inverted = inverse(placement->rows);
    for (size_t i = 0; i < 3; ++i)
        portal.rows[i] = (*inverted)[i] * frame.scale;
    portal.origin = (*placement)(frame.origin);
    portal.bounds = placed_box(box, placement);
    return portal;
}

} // namespace ovc
