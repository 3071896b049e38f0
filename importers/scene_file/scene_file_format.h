// SPDX-License-Identifier: Apache-2.0
// The scene file is an archive of the fields, the meshes' extents, the corners, the normals, the
// texture coordinates, the checksums of blocks of those three, and the levels.
#pragma once

#include "core/transform.h"
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <string_view>

namespace ovc {

inline constexpr std::string_view kSceneKind = "ovc scene";
/// Raise it with every change of scene_fields.h, and when an importer makes another scene of the
/// same file.
inline constexpr uint32_t kSceneVersion = 28;

/// The checksums of the blocks (core/file/file_blocks.h) of corners, normals and texture
/// coordinates.
inline constexpr std::array<const char*, 3> kBlockSums{"corner sums", "normal sums", "uv sums"};

/// The place of a mesh's corners, normals and texture coordinates in the other parts.
struct MeshExtent {
    dvec3 origin{0};
    uint64_t corners = 0; // its own, in the part "corners"
    uint64_t normals = 0;
    uint64_t uv = 0;
    uint64_t corners_from = kOwnCorners; // or an earlier mesh, whose corners this one shares
    uint32_t is_placed = 0;
    uint32_t mask = 0; // of the chunk
    Transform transform{};

    static constexpr uint64_t kOwnCorners = ~uint64_t(0);
};
static_assert(sizeof(MeshExtent) == 160);

} // namespace ovc
