// SPDX-License-Identifier: Apache-2.0
// A bounded pass of the skip-pointer BVH: it reads each ray's place and findings, goes on, and
// writes them again. Rays that have ended do not come here, because retire.frag.glsl has put them
// behind the depth test.
// Based on: thesis, section 3.1.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "scene_texels.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "found.glsl"
#include "single_triangle.glsl"
#include "frame_answer.glsl"
#include "skip_bvh.glsl"

layout(early_fragment_tests) in;
layout(location = 0) uniform int steps;
layout(location = 1) uniform bool first_pass;

layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;
layout(binding = OVC_BINDING_STATE) uniform usampler2D state[3];

layout(location = 0) out uvec4 answer; // valid once the ray has ended; until then it is overwritten
layout(location = 1) out uvec4 place;
layout(location = 2) out uvec4 further;
layout(location = 3) out uvec4 others;

Walk read_walk(ivec2 pixel) {
    uvec4 a = texelFetch(state[0], pixel, 0);
    uvec4 b = texelFetch(state[1], pixel, 0);
    uvec4 c = texelFetch(state[2], pixel, 0);
    Found found = Found(uintBitsToFloat(a.z), uintBitsToFloat(a.w), a.y,
                        uintBitsToFloat(b.x), uintBitsToFloat(b.y), uint[2](b.z, b.w), int(c.x),
                        uintBitsToFloat(c.yz), 8u);
    return Walk(int(a.x), found);
}

void write_walk(Walk walk) {
    Found found = walk.found;
    place = uvec4(walk.at, found.prim, floatBitsToUint(found.best_lo), floatBitsToUint(found.best_hi));
    further = uvec4(floatBitsToUint(found.further_lo), floatBitsToUint(found.further_hi),
                    found.further[0], found.further[1]);
    others = uvec4(uint(found.count), floatBitsToUint(found.weights), 0u);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 org = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS, pixel.y), 0);
    uvec4 dir = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS + 1, pixel.y), 0);
    ivec2 header = ivec2(scene_texel(0).xy);
    float t_end = uintBitsToFloat(org.w);
    Walk walk;
    if (first_pass)
        walk = Walk(t_end < 0.0 ? header.y : header.x, nothing_found(t_end));
    else
        walk = read_walk(pixel);
    go_on(walk, header.y, steps, uintBitsToFloat(org.xyz), uintBitsToFloat(dir.xyz), dir.w);
    answer = frame_answer(walk.found);
    write_walk(walk);
}
