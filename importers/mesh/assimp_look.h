// SPDX-License-Identifier: Apache-2.0
// Converts Assimp's materials and lights: above all those of glTF 2.0, with their textures.
#pragma once

#include "core/scene.h"

#include <assimp/scene.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace ovc {

/// A material of the scene, and what its meshes need besides.
struct AssimpMaterial {
    uint32_t cutout = kNone;  // index into Scene::cutouts
    uint32_t uv_set = 0;      // the texture coordinates that its textures lie on
    bool is_cut_away = false; // nothing of its meshes is seen
};

/// Adds the materials of a file to the scene, with their textures. left_out: receives the names of
/// pictures that are not shown.
std::vector<AssimpMaterial> add_materials(const aiScene& found, const std::filesystem::path& file,
                                          Scene& scene, std::vector<std::string>& left_out);

/// Returns the transform to the world of the node that has a camera or a light of this name;
/// nothing if none has it, so that it is in no part of the scene.
std::optional<aiMatrix4x4> place_of(const aiNode& root, const aiString& name);

/// Adds lights where their nodes stand, in glTF's units. Returns how many it leaves out.
uint64_t add_lights(const aiScene& found, Scene& scene);

} // namespace ovc
