// SPDX-License-Identifier: Apache-2.0
// Compares corners bit by bit. A mesh that borrows its corners from another moves with it.
#include "host/scene/moved_meshes.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <unordered_map>

namespace ovc {
namespace {

/// Returns for each mesh the first with the same corners in memory.
std::vector<uint32_t> lenders_of(const Soup& soup) {
    std::unordered_map<const void*, uint32_t> first;
    std::vector<uint32_t> lenders;
    for (uint32_t mesh = 0; mesh < soup.chunks.size(); ++mesh) {
        const Chunk& chunk = soup.chunks[mesh];
        lenders.push_back(
            chunk.size() == 0 ? mesh : first.try_emplace(chunk.address_of(0), mesh).first->second);
    }
    return lenders;
}

bool same_bits(const void* a, const void* b, size_t size) {
    return std::memcmp(a, b, size) == 0;
}

bool same_place(const Chunk& a, const Chunk& b) {
    return !a.transform() || !b.transform()
               ? !a.transform() && !b.transform()
               : same_bits(a.transform(), b.transform(), sizeof(Transform));
}

/// Whether they differ in nothing but corners and transforms.
bool are_alike(const Chunk& a, const Chunk& b) {
    return a.size() == b.size() && a.double_corners().size() == b.double_corners().size() &&
           a.mask() == b.mask() && same_bits(&a.origin(), &b.origin(), sizeof(dvec3));
}

bool same_triangle(const Chunk& a, const Chunk& b, uint32_t prim) {
    const size_t size = 3 * (a.double_corners().empty() ? sizeof(vec3) : sizeof(dvec3));
    return same_bits(a.address_of(prim), b.address_of(prim), size);
}

/// Finds which triangles of the mesh have other corners.
MovedMesh compared(uint32_t mesh, const Chunk& before, const Chunk& now) {
    MovedMesh moved{mesh, 0, before.size(), !same_place(before, now)};
    while (moved.first < moved.end && same_triangle(before, now, moved.first))
        ++moved.first;
    while (moved.end > moved.first && same_triangle(before, now, moved.end - 1))
        --moved.end;
    if (moved.first == moved.end)
        moved.first = moved.end = 0;
    return moved;
}

} // namespace

std::optional<std::vector<MovedMesh>> moved_meshes(const Soup& before, const Soup& now) {
    const std::vector<uint32_t> lenders = lenders_of(before);
    if (lenders != lenders_of(now))
        return std::nullopt;
    std::vector<MovedMesh> moved;
    std::vector<MovedMesh> all(lenders.size());
    for (uint32_t mesh = 0; mesh < lenders.size(); ++mesh) {
        const Chunk &a = before.chunks[mesh], &b = now.chunks[mesh];
        if (!are_alike(a, b))
            return std::nullopt;
        all[mesh] = {mesh, 0, 0, !same_place(a, b)};
        if (lenders[mesh] != mesh) {
            all[mesh].first = all[lenders[mesh]].first;
            all[mesh].end = all[lenders[mesh]].end;
        } else {
            all[mesh] = compared(mesh, a, b);
            if (all[mesh].end > 0 && !a.owns_corners())
                return std::nullopt; // they are not ours to write
        }
        if (all[mesh].end > 0 || all[mesh].placed)
            moved.push_back(all[mesh]);
    }
    return moved;
}

void move_meshes(Soup& soup, const Soup& now, const std::vector<MovedMesh>& moved) {
    for (const auto& [mesh, first, end, placed] : moved) {
        Chunk& chunk = soup.chunks[mesh];
        const Chunk& to = now.chunks[mesh];
        const auto part = [&](auto corners) {
            return corners.subspan(3 * size_t(first), 3 * size_t(end - first));
        };
        if (end > first && chunk.owns_corners()) {
            if (to.double_corners().empty())
                chunk.set_corners(first, part(to.corners()));
            else
                chunk.set_corners(first, part(to.double_corners()));
        }
        if (placed)
            chunk.place_anew(to.transform() ? std::optional(*to.transform()) : std::nullopt);
    }
}

} // namespace ovc
