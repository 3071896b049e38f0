// SPDX-License-Identifier: Apache-2.0
// The rays of a pass (layout.h), and the pixels of their answers.

OVC_SHARED_TEXELS(OVC_BINDING_RAYS, RayTexels) rays;
uvec4 ray_texel(int i) { return OVC_TEXEL(rays, i); }

// Returns the number of the ray whose answer goes to `pixel`.
int ray_at(ivec2 pixel) {
    ivec2 tile = pixel / OVC_TILE;
    ivec2 inside = pixel % OVC_TILE;
    return ((tile.y * (OVC_ROW_RAYS / OVC_TILE) + tile.x) * OVC_TILE + inside.y) * OVC_TILE +
           inside.x;
}
ivec2 pixel_of(int ray) {
    ivec2 inside = ivec2(ray % OVC_TILE, ray / OVC_TILE % OVC_TILE);
    int tile = ray / (OVC_TILE * OVC_TILE);
    return ivec2(tile % (OVC_ROW_RAYS / OVC_TILE), tile / (OVC_ROW_RAYS / OVC_TILE)) * OVC_TILE +
           inside;
}
