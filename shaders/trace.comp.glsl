// SPDX-License-Identifier: Apache-2.0
// The compute kernel: an invocation is a ray of the pass.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "triangle.glsl"
#include "found.glsl"
#include "traverse.glsl"
#include "level1.glsl"
#include "ray.glsl"
#include "linked.glsl"
#include "walk.glsl"

layout(local_size_x = OVC_GROUP_SIZE) in;
layout(rgba32ui, binding = OVC_BINDING_ANSWERS) uniform writeonly restrict uimage2D answers;

void main() {
    int ray = int(gl_GlobalInvocationID.x);
    Traveller traveller = traveller(ray);
    imageStore(answers, pixel_of(ray), OVC_LINKED != 0 ? trace_linked(traveller) : walk(traveller));
}
