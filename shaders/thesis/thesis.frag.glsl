// SPDX-License-Identifier: Apache-2.0
// The systems of the thesis that trace a ray in one pass: a pixel is a ray. OVC_STRUCTURE is a
// value of ovc_structure (overcast.h).
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "scene_texels.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "times.glsl"
#include "found.glsl"
#include "single_triangle.glsl"
#include "frame_answer.glsl"
#include "rounds.glsl"
#if OVC_STRUCTURE == 3
#include "grid.glsl"
#elif OVC_STRUCTURE == 4
#include "kd_restart.glsl"
#else
#include "children.glsl"
#include "pair.glsl"
#include "traverse.glsl"
#include "one_page.glsl"
#endif

layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;
layout(location = 0) out uvec4 answer;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 org = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS, pixel.y), 0);
    uvec4 dir = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS + 1, pixel.y), 0);
    answer = trace(uintBitsToFloat(org.xyz), uintBitsToFloat(org.w), uintBitsToFloat(dir.xyz), dir.w);
}
