// SPDX-License-Identifier: Apache-2.0
// Groups chunks by the corners that they borrow, and tells which groups are worth sharing.
#include "plugin/build/shared_meshes.h"

#include "core/system/parallel.h"
#include "core/transform.h"
#include "gpu/page/top_level.h"

#include <algorithm>
#include <map>

namespace ovc {
namespace {

/// The bytes of a page for each triangle, roughly.
constexpr uint64_t kBytesPerTriangle = 46;
/// A portal costs rays time, so sharing must save so many times the bytes that it adds.
constexpr uint64_t kWorthAPortal = 4;

/// Returns the box of a mesh before it is placed, empty where a corner is not finite.
Box bounds_of(const Chunk& mesh) {
    struct Found {
        Box box;
        bool is_finite = true;
    };
    const Found all = parallel_reduce(
        mesh.size(), Found(),
        [&](size_t first, size_t last, Found found) {
            for_each_triangle(mesh, uint32_t(first), uint32_t(last), [&](const Triangle& triangle) {
                for (const dvec3& corner : triangle) {
                    found.is_finite &= is_finite(corner);
                    found.box.add(corner);
                }
            });
            return found;
        },
        [](Found a, const Found& b) {
            a.box.add(b.box);
            a.is_finite &= b.is_finite;
            return a;
        });
    return all.is_finite ? all.box : Box();
}

/// Returns the groups of chunks of the same mesh, in the order of their first chunks; the chunks of
/// a group are sorted.
std::vector<std::vector<uint32_t>> by_mesh(const Soup& soup) {
    std::map<Chunk::MeshKey, size_t> found;
    std::vector<std::vector<uint32_t>> meshes;
    for (uint32_t i = 0; i < soup.chunks.size(); ++i) {
        const Chunk& chunk = soup.chunks[i];
        if (chunk.size() == 0)
            continue;
        const auto [place, is_new] = found.try_emplace(chunk.mesh_key(), meshes.size());
        if (is_new)
            meshes.emplace_back();
        meshes[place->second].push_back(i);
    }
    return meshes;
}

/// Takes out the chunks that lie exactly where one before them does.
void take_copies_out(const Soup& soup, std::vector<uint32_t>& chunks, Placed& placed) {
    std::map<decltype(Transform::rows), Placed::Copies> places;
    std::vector<uint32_t> apart;
    for (const uint32_t chunk : chunks) {
        Placed::Copies& copies = places[or_identity(soup.chunks[chunk].transform()).rows];
        if (copies.empty())
            apart.push_back(chunk);
        copies.push_back(chunk);
    }
    for (auto& [rows, copies] : places)
        if (copies.size() > 1)
            placed.copies.push_back(std::move(copies));
    chunks = std::move(apart);
}

} // namespace

Placed placed_chunks(const Soup& soup, const KnownBox& known_box) {
    Placed placed;
    for (std::vector<uint32_t>& chunks : by_mesh(soup)) {
        if (chunks.size() > 1)
            take_copies_out(soup, chunks, placed);
        const Chunk& mesh = soup.chunks[chunks.front()];
        const uint64_t saved = (chunks.size() - 1) * kBytesPerTriangle * mesh.size();
        const bool pays = saved > kWorthAPortal * kMaxBytesPerPart * chunks.size();
        const auto moves = [&](uint32_t chunk) { return soup.chunks[chunk].moves(); };
        const bool any_moves = std::ranges::any_of(chunks, moves);
        std::vector<uint32_t> shared;
        Box box;
        if (pays || any_moves) {
            const std::optional<Box> known = known_box ? known_box(chunks.front()) : std::nullopt;
            box = known ? *known : bounds_of(mesh.unplaced());
        }
        for (const uint32_t chunk : chunks) {
            const bool may_share =
                (pays || moves(chunk)) && is_well_placed(box, soup.chunks[chunk].transform());
            (may_share ? shared : placed.once).push_back(chunk);
        }
        if (shared.size() > 1 || (any_moves && !shared.empty())) {
            placed.shared.push_back(std::move(shared));
            placed.boxes.push_back(box);
        } else {
            placed.once.insert(placed.once.end(), shared.begin(), shared.end());
        }
    }
    std::ranges::sort(placed.once);
    std::ranges::sort(placed.copies);
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

} // namespace ovc
