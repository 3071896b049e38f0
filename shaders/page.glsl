// SPDX-License-Identifier: Apache-2.0
// Units of the pool that pages lie in.
#include "unit.glsl"

#if OVC_TELL_ACTIVE
layout(r32ui, binding = OVC_BINDING_ACTIVE) uniform writeonly restrict uimageBuffer active_leaves;
void mark_active(int leaf) { imageStore(active_leaves, leaf, uvec4(1u)); }
#endif

OVC_TEXELS(OVC_BINDING_POOL) pool[OVC_POOL_BUFFERS];

#define OVC_UNIT_OF(number, at) \
    Unit(OVC_TEXEL(pool[number], at), OVC_TEXEL(pool[number], at + 1), OVC_TEXEL(pool[number], at + 2), OVC_TEXEL(pool[number], at + 3))

#if OVC_POOL_BUFFERS == 1
Unit unit_at(int unit) { return OVC_UNIT_OF(0, unit * OVC_UNIT_TEXELS); }
#else
// GLSL lets no two lanes read different buffers at once. Where lanes can tell each other they go on by turns, those that want the
// first one's buffer together (llvmpipe: 1.5 times the time of one buffer with two of them, 2 times with 27; by the other way 1.7 and
// 10). Else each buffer is asked whether the unit is its own. Based on: thesis, section 3.2 (algorithm 1).
Unit unit_at(int unit) {
    int own = unit >> OVC_BUFFER_BITS;
    int at = (unit & ((1 << OVC_BUFFER_BITS) - 1)) * OVC_UNIT_TEXELS;
    Unit found = Unit(uvec4(0u), uvec4(0u), uvec4(0u), uvec4(0u));
#if OVC_REFILL
    bool wants;
    do {
        int first = readFirstInvocationARB(own);
        wants = own != first;
        if (!wants)
            found = OVC_UNIT_OF(first, at);
    } while (wants);
#else
    for (int i = 0; i < OVC_POOL_BUFFERS; ++i)
        if (i == own)
            found = OVC_UNIT_OF(i, at);
#endif
    return found;
}
#endif
