// SPDX-License-Identifier: Apache-2.0
// The compute kernel: an invocation is a ray of the queue; rows as in the fragment kernel.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "found.glsl"
#include "traverse.glsl"

layout(local_size_x = OVC_GROUP_SIZE) in;
layout(binding = OVC_BINDING_RAYS) uniform usampler2D rays;
layout(rgba32ui, binding = OVC_BINDING_ANSWERS) uniform writeonly restrict uimage2D answers;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uvec4 org = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS, pixel.y), 0);
    uvec4 dir = texelFetch(rays, ivec2(pixel.x * OVC_RAY_TEXELS + 1, pixel.y), 0);
    imageStore(answers, pixel,
               trace(uintBitsToFloat(org.xyz), uintBitsToFloat(org.w), uintBitsToFloat(dir.xyz), dir.w));
}
