// SPDX-License-Identifier: Apache-2.0
// Sums and products of pairs of floats, for gpu/tuning/float_pair_check.h to look at.
#version 450 core
#include "layout.h"
#include "float_pairs.glsl"

layout(local_size_x = OVC_CHECKED_PAIRS) in;
layout(std430, binding = OVC_BINDING_RAYS) readonly restrict buffer Questions { vec4 questions[]; };
layout(std430, binding = OVC_BINDING_ANSWERS) writeonly restrict buffer Answers { vec4 answers[]; };

vec2 words_of(FloatPair pair) { return vec2(pair.hi, pair.lo); }

void main() {
    uint i = gl_GlobalInvocationID.x;
    FloatPair a = FloatPair(questions[i].x, questions[i].y);
    FloatPair b = FloatPair(questions[i].z, questions[i].w);
    answers[2u * i] = vec4(words_of(two_sum(a.hi, b.hi)), words_of(two_product(a.hi, b.hi)));
    answers[2u * i + 1u] = vec4(words_of(sum(a, b)), words_of(product(a, b)));
}
