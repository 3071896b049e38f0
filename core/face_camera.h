// SPDX-License-Identifier: Apache-2.0
// FaceCamera: triangles that look along their normals, as POV-Ray's mesh_camera does. They take the
// place of a camera's window.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc {

/// What the corners of each face have. `normals` is empty or as long as `corners`, and so is `uv`
/// with Order::ByUv; else it is empty.
struct FaceMesh {
    std::vector<std::array<dvec3, 3>> corners;
    std::vector<std::array<vec3, 3>> normals; // that rays follow in place of the faces' own
    std::vector<std::array<vec2, 3>> uv;
};

/// A ray begins in the middle of its face, or at the texture coordinates of its pixel.
struct FaceCamera {
    /// How faces belong to the pixels, which are counted row by row from the top left one.
    enum class Order : uint64_t {
        EachMesh, // a pixel's first ray has its face of the first mesh, the second of the …
        OneAfterAnother, // the second ray of the first pixel follows the first ray of the last one
        SideBySide,      // meshes have parts of the picture, from left to right
        ByUv,            // the face at (u, v) of the pixel, with (0, 0) at the bottom left
    };

    Order order = Order::EachMesh;
    std::vector<FaceMesh> meshes; // not empty
    double ahead = 0;             // the way along the normal from the face to where its ray begins
    bool backwards = false;       // rays go against the normals
};

} // namespace ovc
