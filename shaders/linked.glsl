// SPDX-License-Identifier: Apache-2.0
// A ray through linked pages: all leaves share a frame, and one tree holds them.

#if OVC_LINKED
layout(location = OVC_LOCATION_ROOT) uniform int linked_root;

// The words of an answer (layout.h).
uvec4 trace_linked(int ray) {
    uvec4 from = ray_texel(ray * OVC_LOCAL_RAY_TEXELS);
    uvec4 to = ray_texel(ray * OVC_LOCAL_RAY_TEXELS + 1);
    float t_end = uintBitsToFloat(from.w);
    bool any_hit = (to.w & OVC_RAY_ANY_HIT) != 0u;
    Found found = nothing_found(t_end);
    int rounds = 0;
    bool done = t_end < 0.0;
    if (!done)
        done = traverse(found, linked_root, 0, uintBitsToFloat(from.xyz), t_end, direction_of(uintBitsToFloat(to.xyz)),
                        to.w & OVC_SKIPS_NONE, any_hit, rounds);
    uvec4 answer = answer_of(found, any_hit, OVC_NO_LEAF);
#if !OVC_CERTIFY
    answer.xyz = uvec3(floatBitsToUint(found.best_lo), 0u, packUnorm2x16(barycentric(found)));
#endif
    answer.w = t_end == OVC_UNDECIDABLE ? OVC_FLAGGED : answer.w;
    return done ? answer : uvec4(0u, 0u, OVC_NO_LEAF, OVC_CAPPED);
}
#endif
