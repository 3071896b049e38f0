// SPDX-License-Identifier: Apache-2.0
// moved_meshes() finds what differs between two moments of a scene, so that a backend need not be
// built anew for each.
#pragma once

#include "core/soup.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// A mesh of which something has moved.
struct MovedMesh {
    uint32_t mesh;
    uint32_t first = 0, end = 0; // its triangles [first, end) have other corners
    bool placed = false;         // it has another transform

    bool operator==(const MovedMesh&) const = default;
};

/// Returns the meshes that lie otherwise in `now` than in `before`. Returns nothing where others
/// are there: more or fewer of them, of other sizes, or seen by other rays.
std::optional<std::vector<MovedMesh>> moved_meshes(const Soup& before, const Soup& now);

/// Moves the meshes of `soup` to where they are in `now`, in the memory in which they are. moved:
/// as moved_meshes() tells of the two.
void move_meshes(Soup& soup, const Soup& now, const std::vector<MovedMesh>& moved);

} // namespace ovc
