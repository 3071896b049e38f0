// SPDX-License-Identifier: Apache-2.0
// NormalMap: a texture on the texture coordinates of a surface that tilts its normals.
#pragma once

#include "core/texture/texture.h"

#include <span>

namespace ovc {

struct NormalMap {
    /// Height: the surface is raised by scale x height_at() of a texture on texture coordinates, in
    /// units of the world. Space: by that of a texture in space. Texels: as Height, in units of the
    /// width of a texel. Tangent: the color is (n + 1) / 2 of a normal n
    /// along u, along v and out of the surface, and scale multiplies the first two.
    enum class Kind : uint64_t { Height, Texels, Tangent, Space };

    Kind kind = Kind::Height;
    uint32_t texture = 0; // index into Scene::textures
    double scale = 1;

    bool operator==(const NormalMap&) const = default;
};

/// Returns the tilted normal, of length 1. normal: of length 1, towards the outside, to which
/// heights rise. The point is one of the world. Without texture coordinates all but Space leave it.
dvec3 tilted(std::span<const Texture> textures, const NormalMap& map, const TexturePoint& point,
             const dvec3& normal);

} // namespace ovc
