// SPDX-License-Identifier: Apache-2.0
// Cutout: a picture of where a surface is and where it has holes, so that leaves need no triangles
// of their own.
#pragma once

#include "core/texture/texture.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// The picture covers the unit square of texture coordinates, its first row at v = 1. A hit counts
/// by the opacity of the place: never where that is 0, always from 1 on.
struct Cutout {
    /// The space beyond the unit square has the picture again, its rim, or a hole.
    enum class Beyond : uint8_t { Repeat, Clamp, Hole };

    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> opacity; // width x height rows from the top down; 255 stands for 1
    float scale = 1;              // multiplies the opacity
    dvec2 uv_scale{1};            // the picture is asked at uv_scale * uv + uv_offset
    dvec2 uv_offset{0};
    Beyond beyond = Beyond::Repeat;
    bool smooth = false; // opacity is interpolated between the middles of texels
    /// Between 0 and 1 a hit counts with that probability, which a hash of the hit decides. If
    /// false, it counts.
    bool partial = true;
    /// The opacity is the mean color of this texture instead, an index into Scene::textures;
    /// kNoTexture: it is that of the picture above.
    uint32_t texture = kNoTexture;
    float threshold = 0; // an opacity below this counts as 0, and from here on as 1; 0: as it is

    bool operator==(const Cutout&) const = default;
};

} // namespace ovc
