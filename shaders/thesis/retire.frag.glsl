// SPDX-License-Identifier: Apache-2.0
// Runs after a bounded pass: only pixels whose ray has ended write their depth, and the occlusion
// query counts them.
#version 450 core
#include "layout.h"
#include "config.glsl"
#include "scene_texels.glsl"

layout(binding = OVC_BINDING_STATE) uniform usampler2D state[3];

void main() {
    if (int(texelFetch(state[0], ivec2(gl_FragCoord.xy), 0).x) < int(scene_texel(0).y))
        discard;
}
