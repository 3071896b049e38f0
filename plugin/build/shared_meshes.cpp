// SPDX-License-Identifier: Apache-2.0
// Groups chunks by the corners that they borrow, and tells which groups are worth sharing.
#include "plugin/build/shared_meshes.h"

#include "core/system/parallel.h"
#include "core/transform.h"
#include "gpu/page/top_level.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <span>
#include <utility>

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

/// Returns the transform's numbers as bits, which have an order where a product has come to be NaN,
/// too. -0 is 0.
std::array<uint64_t, 12> bits_of(const Transform& transform) {
    std::array<uint64_t, 12> bits;
    for (size_t i = 0; i < bits.size(); ++i)
        bits[i] = std::bit_cast<uint64_t>(transform.rows[i / 4][i % 4] + 0.0);
    return bits;
}

/// Takes out the chunks that lie exactly where one before them does.
void take_copies_out(const Soup& soup, std::vector<uint32_t>& chunks, Placed& placed) {
    std::map<std::array<uint64_t, 12>, Placed::Copies> places;
    std::vector<uint32_t> apart;
    for (const uint32_t chunk : chunks) {
        Placed::Copies& copies = places[bits_of(or_identity(soup.chunks[chunk].transform()))];
        if (copies.empty())
            apart.push_back(chunk);
        copies.push_back(chunk);
    }
    for (auto& [bits, copies] : places)
        if (copies.size() > 1)
            placed.copies.push_back(std::move(copies));
    chunks = std::move(apart);
}

/// Whether the chunks of the mesh lie where those of the meshes before it do, each behind them.
bool lie_with(const Soup& soup, const Placed::Shared& before, std::span<const uint32_t> chunks) {
    return std::ranges::equal(before.places, chunks, [&](uint32_t first, uint32_t chunk) {
        return chunk == first + before.chunks &&
               or_identity(soup.chunks[chunk].transform()).rows ==
                   or_identity(soup.chunks[first].transform()).rows;
    });
}

/// Returns all meshes, those that lie together in several places as one. One that moves is alone.
/// The boxes are yet to be found.
std::vector<Placed::Shared> lying_together(const Soup& soup, Placed& placed) {
    std::vector<Placed::Shared> found;
    bool before_moves = true;
    for (std::vector<uint32_t>& chunks : by_mesh(soup)) {
        if (chunks.size() > 1)
            take_copies_out(soup, chunks, placed);
        const bool moves =
            std::ranges::any_of(chunks, [&](uint32_t chunk) { return soup.chunks[chunk].moves(); });
        if (chunks.size() > 1 && !moves && !before_moves && lie_with(soup, found.back(), chunks))
            ++found.back().chunks;
        else
            found.push_back({.places = std::move(chunks)});
        before_moves = moves;
    }
    return found;
}

/// Returns the number of triangles in one place.
uint64_t triangles_of(const Soup& soup, const Placed::Shared& meshes) {
    uint64_t count = 0;
    for (uint32_t i = 0; i < meshes.chunks; ++i)
        count += soup.chunks[meshes.places.front() + i].size();
    return count;
}

/// Returns the box of the meshes before they are placed, empty where a corner is not finite.
Box box_of(const Soup& soup, const Placed::Shared& meshes, const KnownBox& known_box) {
    Box all;
    for (uint32_t i = 0; i < meshes.chunks; ++i) {
        const uint32_t chunk = meshes.places.front() + i;
        const std::optional<Box> known = known_box ? known_box(chunk) : std::nullopt;
        const Box box = known ? *known : bounds_of(soup.chunks[chunk].unplaced());
        if (box.empty())
            return {};
        all.add(box);
    }
    return all;
}

} // namespace

Placed placed_chunks(const Soup& soup, const KnownBox& known_box) {
    Placed placed;
    for (Placed::Shared& meshes : lying_together(soup, placed)) {
        const auto moves = [&](uint32_t chunk) { return soup.chunks[chunk].moves(); };
        const size_t places = meshes.places.size();
        const uint64_t saved = (places - 1) * kBytesPerTriangle * triangles_of(soup, meshes);
        const bool pays = saved > kWorthAPortal * kMaxBytesPerPart * places;
        const bool any_moves = std::ranges::any_of(meshes.places, moves);
        if (pays || any_moves)
            meshes.box = box_of(soup, meshes, known_box);
        std::vector<uint32_t> shared, once;
        for (const uint32_t place : meshes.places) {
            const bool may_share = (pays || moves(place)) &&
                                   is_well_placed(meshes.box, soup.chunks[place].transform());
            (may_share ? shared : once).push_back(place);
        }
        if (shared.size() == 1 && !any_moves) {
            once.push_back(shared.front());
            shared.clear();
        }
        meshes.places = std::move(once);
        meshes.for_each_chunk([&](uint32_t chunk) { placed.once.push_back(chunk); });
        if (shared.empty())
            continue;
        meshes.places = std::move(shared);
        placed.shared.push_back(std::move(meshes));
    }
    std::ranges::sort(placed.once);
    std::ranges::sort(placed.copies);
    return placed;
}

uint64_t unique_triangles(const Soup& soup, const Placed& placed) {
    uint64_t count = 0;
    for (const uint32_t chunk : placed.once)
        count += soup.chunks[chunk].size();
    for (const Placed::Shared& meshes : placed.shared)
        count += triangles_of(soup, meshes);
    return count;
}

} // namespace ovc
