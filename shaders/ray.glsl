// SPDX-License-Identifier: Apache-2.0
// The rays of a pass: OVC_RAY_TEXELS texels each.

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

// Rays lie in rows, as their answers do.
Traveller traveller_at(ivec2 pixel) {
    int texel = (pixel.y * OVC_ROW_RAYS + pixel.x) * OVC_RAY_TEXELS;
    dvec2 a = ray_doubles(texel);
    dvec2 b = ray_doubles(texel + 1);
    dvec2 c = ray_doubles(texel + 2);
    dvec2 d = ray_doubles(texel + 3);
    uvec4 e = ray_texel(texel + 4);
    dvec3 dir = dvec3(c, d.x);
    dvec3 inv_dir = 1.0 / mix(dir, dvec3(1.0), equal(dir, dvec3(0.0))); // a still coordinate has none
    return Traveller(WorldRay(dvec3(a, b.x), dir, inv_dir, b.y, d.y), double_of(e.xy), int(e.w & OVC_NO_LEAF), e.z,
                     (e.w & OVC_RAY_ANY_HIT) != 0u);
}
