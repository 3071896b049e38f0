// SPDX-License-Identifier: Apache-2.0
// The fragment kernel: a pixel is a ray of the queue.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "found.glsl"
#include "traverse.glsl"

layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;
layout(location = 0) out uvec4 answer;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 org = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS, pixel.y), 0);
    uvec4 dir = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS + 1, pixel.y), 0);
    answer = trace(uintBitsToFloat(org.xyz), uintBitsToFloat(org.w), uintBitsToFloat(dir.xyz), dir.w);
}
