// SPDX-License-Identifier: Apache-2.0
// The rays of a pass: OVC_RAY_TEXELS texels each, and the pixels of their answers.

#if OVC_BUFFER_IMAGES
layout(rgba32ui, binding = OVC_BINDING_RAYS) uniform readonly restrict uimageBuffer rays;
uvec4 ray_texel(int i) { return imageLoad(rays, i); }
#else
layout(binding = OVC_BINDING_RAYS) uniform usamplerBuffer rays;
uvec4 ray_texel(int i) { return texelFetch(rays, i); }
#endif

dvec2 ray_doubles(int texel) {
    uvec4 words = ray_texel(texel);
    return dvec2(double_of(words.xy), double_of(words.zw));
}

// What a ray comes with (layout.h): itself, where its walk begins, the triangle it does not see, and what it asks.
struct Traveller {
    WorldRay ray;
    double t_from;
    int first_leaf;
    uint skip;
    bool any_hit; // occlusion: stop at the first certain hit
};

// The number of the ray whose answer goes to `pixel`.
int ray_at(ivec2 pixel) {
    ivec2 tile = pixel / OVC_TILE;
    ivec2 inside = pixel % OVC_TILE;
    return ((tile.y * (OVC_ROW_RAYS / OVC_TILE) + tile.x) * OVC_TILE + inside.y) * OVC_TILE + inside.x;
}
ivec2 pixel_of(int ray) {
    ivec2 inside = ivec2(ray % OVC_TILE, ray / OVC_TILE % OVC_TILE);
    int tile = ray / (OVC_TILE * OVC_TILE);
    return ivec2(tile % (OVC_ROW_RAYS / OVC_TILE), tile / (OVC_ROW_RAYS / OVC_TILE)) * OVC_TILE + inside;
}

Traveller traveller(int ray) {
    int texel = ray * OVC_RAY_TEXELS;
    dvec2 a = ray_doubles(texel);
    dvec2 b = ray_doubles(texel + 1);
    dvec2 c = ray_doubles(texel + 2);
    dvec2 d = ray_doubles(texel + 3);
    uvec4 e = ray_texel(texel + 4);
    dvec3 dir = dvec3(c, d.x);
    dvec3 inv_dir = 1.0 / mix(dir, dvec3(1.0), equal(dir, dvec3(0.0))); // a still coordinate has none
    return Traveller(WorldRay(dvec3(a, b.x), dir, inv_dir, b.y, d.y), double_of(e.xy), int(e.w & OVC_NO_LEAF), e.z,
                     OVC_ANY_HIT != 0 || (e.w & OVC_RAY_ANY_HIT) != 0u);
}
