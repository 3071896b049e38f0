// SPDX-License-Identifier: Apache-2.0
// What a traversal knows so far about a ray that asks whether anything is hit: whether something
// certainly is, and otherwise which triangles may be (docs/design/numerics.md). This file stands in
// for found.glsl and has the same names. It computes no distance, so nothing is divided.

struct Found {
    float best_hi; // the ray's end; OVC_ENOUGH: it certainly hits something
    uint further[3]; // the last triangles that it may hit, but not certainly; two can be named
};

Found nothing_found(float t_end) {
    return Found(t_end, uint[3](OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_TRIANGLE));
}

// Takes the triangle (a, b, c) in. Returns true when the ray certainly hits it.
bool take(inout Found found, Corner a, Corner b, Corner c, Edges e, Depths depths, bool valid,
          uint prim, uint order) {
    Passing passing = passing_of(e);
    // The hit's t, its error bound, and the ray's end, each times the area, which has a sign.
    float area = e.ab + e.bc + e.ca;
    float volume = e.bc * a.z + e.ca * b.z + e.ab * c.z;
    float t = uintBitsToFloat(floatBitsToUint(volume) ^ (floatBitsToUint(area) & 0x80000000u));
    float error = float(OVC_BOUND_SHARE) * (e.ab_error + e.bc_error + e.ca_error) *
                      (depths.hi - depths.lo) +
                  abs(area) * depths.error;
    // The end of a ray that has its answer counts as 0: a product with its -2^-123 is subnormal,
    // and takes the CPU a hundred cycles.
    float end = abs(area) * intBitsToFloat(max(floatBitsToInt(found.best_hi), 0));
    float lo = t - error, hi = t + error;
    int between = ~(floatBitsToInt(lo) | less(end, hi));
    int beyond = floatBitsToInt(hi) | less(end, lo);
    bool took = valid && (passing.inside & between) < 0;
    bool may_hit = valid && ~(passing.outside | (passing.inside & (between | beyond))) < 0;
    found.further[2] = may_hit ? found.further[1] : found.further[2];
    found.further[1] = may_hit ? found.further[0] : found.further[1];
    found.further[0] = may_hit ? prim : found.further[0];
    return took;
}

// A triangle that planes cut may be a further candidate of its own parts. It is then named again
// and resolved once more.
bool is_known(Found found, uint prim) { return false; }

bool has_hit(Found found) { return false; }

#if OVC_PORTALS
// Returns the same in another frame. t_end: the ray's end there.
Found in_times(Found found, Times from, Times to, float t_end) {
    found.best_hi = t_end;
    return found;
}
#endif

// Returns whether so many triangles may be hit that not all can be named.
bool are_too_many(Found found) { return found.further[2] != OVC_NO_TRIANGLE; }

float first_t(Found found) { return -3.0e38; } // not known
void end_behind_candidates(inout Found found, bool any_hit) {}

// The words of an answer from `leaf`. They do not tell which triangle is hit.
uvec4 answer_of(Found found, bool any_hit, uint leaf) {
    if (found.best_hi == OVC_ENOUGH)
        return uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, leaf, 0u);
    return uvec4(found.further[0], found.further[1], leaf,
                 are_too_many(found) ? OVC_FLAGGED : OVC_MISS);
}
