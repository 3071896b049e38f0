// SPDX-License-Identifier: Apache-2.0
// The compute kernel: an invocation is a ray of the pass; rows as in the fragment kernel.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "found.glsl"
#include "traverse.glsl"
#include "level1.glsl"
#include "walk.glsl"
#include "ray.glsl"

layout(local_size_x = OVC_GROUP_SIZE) in;
layout(rgba32ui, binding = OVC_BINDING_ANSWERS) uniform writeonly restrict uimage2D answers;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    imageStore(answers, pixel, walk(traveller_at(pixel)));
}
