// SPDX-License-Identifier: Apache-2.0
// Tests a triangle by itself, which lies in three texels: its corners, and its id in w of the first
// texel (whose highest bit may mark a triangle).

// Takes the triangle in. Returns true when it is now the best.
bool take_triangle(inout Found found, uvec4 A, uvec4 B, uvec4 C, bool valid, Line line, uint skip) {
    Corner a = corner(uintBitsToFloat(A.xyz), line);
    Corner b = corner(uintBitsToFloat(B.xyz), line);
    Corner c = corner(uintBitsToFloat(C.xyz), line);
    float error = error_of(a, b, c);
    Candidate hit =
        candidate(a, b, c, edges_of(a, b, c, error), with_corner(depths_of(a, b, error), c));
    uint prim = A.w & 0x7fffffffu;
    // A triangle that is listed in several cells is offered several times. It is not a second
    // candidate.
    bool known = prim == found.prim || prim == found.further[0] || prim == found.further[1];
    return take(found, hit, valid && !known && prim != skip, prim, 8u);
}
