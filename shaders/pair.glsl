// SPDX-License-Identifier: Apache-2.0
// Tests a unit's two triangles (layout.h) and offers them to Found: take_pair() returns true when
// one of them was taken. The unit's triangle numbers count from first_number.

#if OVC_LOOSE_PAIRS
// The coordinate in the upper 24 bits of a word, and the one in the low bytes of three.
float upper(uint word) { return float(int(word) >> 8) * float(OVC_LOOSE_STEP); }
float low(uvec4 words) {
    return upper((words.z << 24) | ((words.y & 0xffu) << 16) | ((words.x & 0xffu) << 8));
}
vec3 upper(uvec4 words) { return vec3(ivec3(words.xyz) >> 8) * float(OVC_LOOSE_STEP); }

bool take_alone(inout Found found, Corner v[3], bool valid, uint prim, uint order) {
    float error = error_of(v[0], v[1], v[2]);
    return take(found, v[0], v[1], v[2], edges_of(v[0], v[1], v[2], error),
                with_corner(depths_of(v[0], v[2], error), v[1]), valid, prim, order);
}

// Takes a pair of either kind. If it is not a loose pair, two of B's corners are A's.
bool take_pair(inout Found found, uvec4 X, uvec4 Y, uvec4 Z, uvec4 W, bool is_pair, Line line,
               uint skip, uint first_number) {
    uint number_a = X.w + first_number, number_b = Y.w + first_number;
    bool loose = (W.w & OVC_LOOSE_PAIR) != 0u;
    vec3 p0 = loose ? upper(X) : uintBitsToFloat(X.xyz);
    vec3 p1 = loose ? upper(Y) : uintBitsToFloat(Y.xyz);
    vec3 p2 = loose ? upper(Z) : uintBitsToFloat(Z.xyz);
    vec3 p3 = loose ? upper(W) : uintBitsToFloat(W.xyz);
    vec3 b1 = vec3(low(X), low(Y), low(Z));
    vec3 b2 = vec3(low(W), upper(Z.w), upper((Z.w << 24) | ((W.w & 0xffffu) << 8)));
    uint order = loose ? OVC_OWN_ORDER : Z.w;
    Corner a[3] = Corner[3](corner(p0, line), corner(p1, line), corner(p2, line));
    Corner b[3] = Corner[3](corner(loose ? p3 : p0, line), corner(loose ? b1 : p3, line),
                            corner(loose ? b2 : p2, line));
    bool seen_a = is_pair && number_a != skip && !is_known(found, number_a);
    bool seen_b = is_pair && number_b != skip && Y.w != OVC_NO_TRIANGLE && !is_known(found, number_b);
    bool took_a = take_alone(found, a, seen_a, number_a, order);
    bool took_b = take_alone(found, b, seen_b, number_b, order >> 4);
    return took_a || took_b;
}
#else
bool take_pair(inout Found found, uvec4 X, uvec4 Y, uvec4 Z, uvec4 W, bool is_pair, Line line,
               uint skip, uint first_number) {
    uint number_a = X.w + first_number, number_b = Y.w + first_number;
    Corner v0 = corner(uintBitsToFloat(X.xyz), line);
    Corner v1 = corner(uintBitsToFloat(Y.xyz), line);
    Corner v2 = corner(uintBitsToFloat(Z.xyz), line);
    Corner v3 = corner(uintBitsToFloat(W.xyz), line);
    float error = error_of(v0, v1, v2, v3);
    float e20 = edge(v2, v0);
    float e20_error = edge_error(v2, v0, error);
    Depths depths = depths_of(v0, v2, error);
    Edges a = Edges(edge(v0, v1), edge(v1, v2), e20, edge_error(v0, v1, error),
                    edge_error(v1, v2, error), e20_error);
    Edges b = Edges(edge(v0, v3), edge(v3, v2), e20, edge_error(v0, v3, error),
                    edge_error(v3, v2, error), e20_error);
    bool seen_a = is_pair && number_a != skip && !is_known(found, number_a);
    bool seen_b = is_pair && number_b != skip && Y.w != OVC_NO_TRIANGLE && !is_known(found, number_b);
    bool took_a = take(found, v0, v1, v2, a, with_corner(depths, v1), seen_a, number_a, Z.w);
    bool took_b = take(found, v0, v3, v2, b, with_corner(depths, v3), seen_b, number_b, Z.w >> 4);
    return took_a || took_b;
}
#endif
