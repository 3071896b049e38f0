// SPDX-License-Identifier: Apache-2.0
// The scene as one array of texels, in one square texture or tiled over several behind one look-up
// with branches.
// Based on: thesis, section 3.2 (algorithm 1).
#include "unit.glsl"

// The number of textures. Each costs a fetch in every look-up where the lanes of a group fetch
// together.
#ifndef OVC_TILES
#define OVC_TILES 1
#endif
#ifndef OVC_TILE_BITS
#define OVC_TILE_BITS 24 // a texture holds 2^bits texels
#endif
#ifndef OVC_TILE_SHIFT
#define OVC_TILE_SHIFT 12 // and is 2^shift texels wide
#endif

layout(binding = OVC_BINDING_SCENE) uniform usampler2D scene[OVC_TILES];

uvec4 scene_texel(int i) {
    ivec2 at = ivec2(i & ((1 << OVC_TILE_SHIFT) - 1),
                     (i & ((1 << OVC_TILE_BITS) - 1)) >> OVC_TILE_SHIFT);
#if OVC_TILES > 1
    int tile = i >> OVC_TILE_BITS;
#define OVC_IN_TILE(n) if (tile == n) return texelFetch(scene[n], at, 0)
#if OVC_TILES > 2
    OVC_IN_TILE(1);
#endif
#if OVC_TILES > 3
    OVC_IN_TILE(2);
#endif
#if OVC_TILES > 4
    OVC_IN_TILE(3);
#endif
#if OVC_TILES > 5
    OVC_IN_TILE(4);
#endif
#if OVC_TILES > 6
    OVC_IN_TILE(5);
#endif
#if OVC_TILES > 7
    OVC_IN_TILE(6);
#endif
    if (tile == OVC_TILES - 1)
        return texelFetch(scene[OVC_TILES - 1], at, 0);
#endif
    return texelFetch(scene[0], at, 0);
}

Unit unit_at(int unit) {
    int at = unit * OVC_UNIT_TEXELS;
    return Unit(scene_texel(at), scene_texel(at + 1), scene_texel(at + 2), scene_texel(at + 3));
}
