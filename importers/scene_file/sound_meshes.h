// SPDX-License-Identifier: Apache-2.0
// has_sound_meshes() checks what a renderer relies on in the meshes of every scene that was read.
#pragma once

#include "core/scene.h"

namespace ovc {

/// Returns whether each chunk has its mesh, each mesh has a material that exists, its normals
/// come from itself or an earlier mesh and are none or one per corner, as do its texture
/// coordinates, which a mesh with a cutout has.
inline bool has_sound_meshes(const Scene& scene) {
    if (scene.meshes.size() != scene.soup.chunks.size())
        return false;
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const MeshInfo& mesh = scene.meshes[m];
        if (mesh.material >= scene.materials.size() ||
            (mesh.normals_from != kNone && mesh.normals_from >= m) ||
            (mesh.uv_from != kNone && mesh.uv_from >= m))
            return false;
        const size_t corners = 3 * size_t(scene.soup.chunks[m].size());
        const size_t normals = scene.normals_of(mesh).size();
        if (normals != 0 && normals != corners)
            return false;
        const size_t uv = scene.uv_of(mesh).size();
        if (uv != 0 && uv != corners)
            return false;
        for (const uint32_t cutout : {mesh.cutout, mesh.shadow_cutout})
            if (cutout != kNone && (cutout >= scene.cutouts.size() || uv != corners))
                return false;
    }
    return true;
}

} // namespace ovc
