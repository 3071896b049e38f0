// SPDX-License-Identifier: Apache-2.0
// A pass of two-level as the thesis has it: it traces the queue of one leaf, whose page lies in the
// pool. A pixel is a ray in the leaf's frame; nearest-hit rays come first, occlusion rays after
// them.
// Based on: thesis, section 3.4 (IntersectL2 of algorithm 3).
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "children.glsl"
#include "triangle.glsl"
#include "times.glsl"
#include "found.glsl"
#include "pair.glsl"
#include "traverse.glsl"
#include "frame_answer.glsl"
#include "one_page.glsl"

layout(location = 0) uniform int page_unit; // where the leaf's page begins in the pool
layout(location = 1) uniform int first_occlusion_ray;

layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;
layout(location = 0) out uvec4 answer;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec4 org = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS, pixel.y), 0);
    uvec4 dir = texelFetch(rays, ivec2(pixel.x * OVC_FRAME_RAY_TEXELS + 1, pixel.y), 0);
    bool any_hit = pixel.y * OVC_QUEUE_ROW_RAYS + pixel.x >= first_occlusion_ray;
    answer = trace_page(page_unit, uintBitsToFloat(org.xyz), uintBitsToFloat(org.w),
                        uintBitsToFloat(dir.xyz), dir.w, any_hit);
}
