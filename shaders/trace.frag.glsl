// SPDX-License-Identifier: Apache-2.0
// The fragment kernel: each pixel traces one ray of the pass.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "page.glsl"
#include "box.glsl"
#include "children.glsl"
#include "triangle.glsl"
#include "times.glsl"
#if OVC_ANY_HIT && OVC_CERTIFY
#include "occluder.glsl"
#else
#include "found.glsl"
#endif
#include "pair.glsl"
#include "traverse.glsl"
#include "ray.glsl"
#include "portals.glsl"
#include "trace.glsl"

layout(location = 0) out uvec4 answer;

void give(int ray, uvec4 words) { answer = words; }

void main() {
    trace_once(ray_at(ivec2(gl_FragCoord.xy)), OVC_MAX_ROUNDS);
}
