// SPDX-License-Identifier: Apache-2.0
// The compute kernel: an invocation takes rays of the pass, OVC_PACKET at a time; those of its
// number, or where subgroups claim rays, one after another.
#version 450 core
#if OVC_CERTIFY && !OVC_ANY_HIT
#define OVC_NAMES OVC_MAX_NAMES
#endif
#include "layout.h"
#include "config.glsl"
#if OVC_CLAIMS
#extension GL_ARB_gpu_shader_int64 : require // ballotARB() returns a 64-bit integer
#extension GL_ARB_shader_ballot : require
#endif
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

layout(local_size_x = OVC_GROUP_SIZE) in;
layout(r32ui, binding = OVC_BINDING_ANSWERS) uniform writeonly restrict uimageBuffer answers;
layout(location = OVC_LOCATION_PLANE) uniform int plane;
layout(location = OVC_LOCATION_RAYS) uniform int ray_count;
// A miss is not written, because the host has put it there before (gpu/trace/answers.h).
void give(int ray, uvec4 answer) {
    bool more = answer.x != OVC_NO_TRIANGLE || (OVC_MAY_WAIT != 0 && answer.z != OVC_NO_LEAF);
    uint word = answer.w | (more ? OVC_SAYS_MORE : 0u);
    if (word != OVC_MISS)
        imageStore(answers, ray, uvec4(word));
    if (more) {
        imageStore(answers, plane + ray, uvec4(answer.x));
        imageStore(answers, 2 * plane + ray, uvec4(answer.y));
        if (OVC_MAY_WAIT != 0)
            imageStore(answers, 3 * plane + ray, uvec4(answer.z));
    }
}

#if OVC_NAMES > 2
layout(r32ui, binding = OVC_BINDING_NAMES) uniform writeonly uimageBuffer names;

int names_of(int ray) {
#if OVC_PORTALS
    return ray * 4 * OVC_RAY_TEXELS;
#elif OVC_MAY_WAIT
    return ray * 4 * OVC_RESUMED_RAY_TEXELS;
#else
    return ray * 4 * OVC_LOCAL_RAY_TEXELS;
#endif
}

// One loop for both rays of a packet, of which most lanes store nothing: llvmpipe goes through 16
// lanes for each store, whether any has something to store or not, and through a loop once.
void give_names(int first, Found found[OVC_PACKET], int counts[OVC_PACKET]) {
    const int last = OVC_PACKET - 1;
    bool at_last = OVC_PACKET == 1 || counts[0] == 0;
    int left = at_last ? counts[last] : counts[0];
    int to = names_of(at_last ? first + last : first);
    uint coming[OVC_NAMES];
    for (int i = 0; i < OVC_NAMES; ++i)
        coming[i] = at_last ? found[last].further[i] : found[0].further[i];
    do {
        if (left > 0)
            imageStore(names, to, uvec4(coming[0]));
        --left;
        ++to;
        bool turns = left == 0 && !at_last;
        for (int i = 0; i < OVC_NAMES; ++i) {
            uint next = i + 1 < OVC_NAMES ? coming[i + 1] : OVC_NO_TRIANGLE;
            coming[i] = turns ? found[last].further[i] : next;
        }
        left = turns ? counts[last] : left;
        to = turns ? names_of(first + last) : to;
        at_last = at_last || turns;
    } while (left > 0);
}
#endif

#if OVC_CLAIMS
layout(location = OVC_LOCATION_LANE_RAYS) uniform int lane_rays;
layout(binding = OVC_BINDING_SHARES) uniform atomic_uint shares;

// Returns the next number that no subgroup has, the same in all lanes.
int claim() {
    uint lanes_before = uint(ballotARB(true)) & ((1u << gl_SubGroupInvocationARB) - 1u);
    uint number = 0u;
    if (lanes_before == 0u)
        number = atomicCounterIncrement(shares);
    return int(readFirstInvocationARB(number));
}

// Returns a number that is at least that of each lane, the same in all lanes, and at most twice
// the largest, or 64.
int most_of(int rounds) {
    int most = 64;
    bool is_less;
    do {
        is_less = ballotARB(rounds > most) != 0ul;
        most = is_less ? 2 * most : most;
    } while (is_less);
    return most;
}

// Traces the rays from `begin` to before `end` by the lanes of the subgroup, within max_rounds.
// Returns how many rounds that took, the same in all lanes; never fewer than llvmpipe has counted.
int trace_share(int begin, int end, int max_rounds) {
#if OVC_REFILL
    return most_of(trace_with_refill(begin, end, max_rounds));
#else
    int rounds = 0;
    for (int first = begin; first < end; first += int(gl_SubGroupSizeARB) * OVC_PACKET) {
        int ray = first + int(gl_SubGroupInvocationARB) * OVC_PACKET;
        // Lanes wait for each other at every portal, and llvmpipe counts until the last has come.
        rounds += (OVC_PORTALS != 0 ? 2 : 1) * most_of(trace_once(ray, max_rounds - rounds));
    }
    return rounds;
#endif
}

// A subgroup claims shares of the pass until there are none left. There are as many subgroups as
// shares, each of which claims one at least; so a thread that gets less time takes fewer, instead
// of being waited for (llvmpipe gives each thread as many groups before it begins: 1 to 16 % of the
// time of calls).
void trace_shares() {
    int share = int(gl_SubGroupSizeARB) * lane_rays;
    int rounds = 0;
    bool more;
    do {
        int begin = claim() * share;
        rounds += trace_share(begin, min(begin + share, ray_count), OVC_MAX_ROUNDS - rounds);
        more = begin + share < ray_count && rounds < OVC_MAX_ROUNDS / 2;
    } while (more);
}
#endif

void main() {
#if OVC_CLAIMS
    trace_shares();
#else
    trace_once(int(gl_GlobalInvocationID.x) * OVC_PACKET, OVC_MAX_ROUNDS);
#endif
}
