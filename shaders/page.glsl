// SPDX-License-Identifier: Apache-2.0
// The pool, and how the kernel reads units from it.
#include "unit.glsl"

#if OVC_TELL_ACTIVE
layout(r32ui, binding = OVC_BINDING_ACTIVE) uniform writeonly restrict uimageBuffer active_leaves;
void mark_active(int leaf) { imageStore(active_leaves, leaf, uvec4(1u)); }
#endif

OVC_TEXELS(OVC_BINDING_POOL, PoolTexels) pool[OVC_POOL_BUFFERS];

#define OVC_UNIT_OF(number, at) \
    Unit(OVC_TEXEL(pool[number], at), OVC_TEXEL(pool[number], at + 1), \
         OVC_TEXEL(pool[number], at + 2), OVC_TEXEL(pool[number], at + 3))

#if OVC_POOL_BUFFERS == 1
Unit unit_at(int unit) { return counted(OVC_UNIT_OF(0, unit * OVC_UNIT_TEXELS)); }
#else
// Each buffer is asked whether the unit is its own, because GLSL lets no two lanes read different
// buffers at once. The calls are written out, because a loop would count among those that llvmpipe
// ends (gpu/gl/workarounds.h, counted-rounds). Based on: thesis, section 3.2 (algorithm 1).
Unit unit_at(int unit) {
    int own = unit >> OVC_BUFFER_BITS;
    int at = (unit & ((1 << OVC_BUFFER_BITS) - 1)) * OVC_UNIT_TEXELS;
    Unit found;
#define OVC_FROM_BUFFER(number) if (own == number) found = OVC_UNIT_OF(number, at);
    OVC_EACH_BUFFER(OVC_FROM_BUFFER)
    return counted(found);
}
#endif
