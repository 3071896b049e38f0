// SPDX-License-Identifier: Apache-2.0
// The rays of a pass: a texture, OVC_RAY_TEXELS texels each.

layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;

dvec2 ray_doubles(ivec2 pixel, int texel) {
    uvec4 words = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS + texel, pixel.y), 0);
    return dvec2(double_of(words.xy), double_of(words.zw));
}

Traveller traveller_at(ivec2 pixel) {
    dvec2 a = ray_doubles(pixel, 0);
    dvec2 b = ray_doubles(pixel, 1);
    dvec2 c = ray_doubles(pixel, 2);
    dvec2 d = ray_doubles(pixel, 3);
    uvec4 e = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS + 4, pixel.y), 0);
    dvec3 dir = dvec3(c, d.x);
    dvec3 inv_dir = 1.0 / mix(dir, dvec3(1.0), equal(dir, dvec3(0.0))); // a still coordinate has none
    return Traveller(WorldRay(dvec3(a, b.x), dir, inv_dir, b.y, d.y), double_of(e.xy), int(e.w), e.z);
}
