// SPDX-License-Identifier: Apache-2.0
// Converts Assimp's meshes, placed where its nodes put them.
#pragma once

#include "core/result.h"
#include "importers/mesh/assimp_look.h"

#include <span>
#include <vector>

namespace ovc {

/// Adds the meshes of all nodes, cut into triangles, to a scene that has its materials. materials:
/// those of the scene. on_uv: for each, whether its textures lie on texture coordinates.
Result<Done> add_meshes(const aiScene& found, std::span<const AssimpMaterial> materials,
                        const std::vector<bool>& on_uv, Scene& scene);

} // namespace ovc
