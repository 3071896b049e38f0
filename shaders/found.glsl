// SPDX-License-Identifier: Apache-2.0
// What a traversal knows so far about the nearest hit: the best certain hit, and the candidates
// that might still be nearer (docs/design/numerics.md).

const float OVC_NEVER = 3.0e38;

// A certain hit in [best_lo, best_hi], and the further candidates: triangles that may be hit, but
// not certainly farther than the best. The two that may be hit first are named; of all others only
// the min t is kept.
struct Found {
    float best_lo;
    float best_hi;
    uint prim;
    float further_lo[2];
    uint further[2];
    float others_lo;
    vec2 weights; // fast precision: of the pair's corners except v0; `order` makes u and v of them
    uint order;
};

Found nothing_found(float t_end) {
    return Found(OVC_NEVER, t_end, OVC_MISS, float[2](OVC_NEVER, OVC_NEVER),
                 uint[2](OVC_NO_TRIANGLE, OVC_NO_TRIANGLE), OVC_NEVER, vec2(0.0), 8u);
}

// Adds a candidate: keeps the two nearest of the further ones and this one.
void add_further(inout Found found, float lo, uint prim) {
    bool first = lo < found.further_lo[0];
    bool second = lo < found.further_lo[1];
    float no_first = greater(lo, found.further_lo[0]);
    float no_second = greater(no_first, found.further_lo[1]);
    found.further_lo[0] = lesser(lo, found.further_lo[0]);
    found.further_lo[1] = lesser(no_first, found.further_lo[1]);
    found.others_lo = lesser(no_second, found.others_lo);
    found.further[1] = first ? found.further[0] : (second ? prim : found.further[1]);
    found.further[0] = first ? prim : found.further[0];
}

// Takes a candidate in. Returns true when it is now the best.
bool take(inout Found found, Candidate c, bool valid, uint prim, uint order) {
    bool possible = valid && c.possible && c.hi >= 0.0;
#if OVC_PORTALS
    // A hit beyond the end of a part is met in another part, and a triangle that parts share may be
    // in doubt in several of them.
    bool named = (prim == found.further[0] && found.further_lo[0] < OVC_NEVER) ||
                 (prim == found.further[1] && found.further_lo[1] < OVC_NEVER);
    possible = possible && c.lo <= found.best_hi && (c.certain || !named);
#endif
    bool better = possible && c.certain && (c.lo > 0.0 || OVC_CERTIFY == 0) &&
                  c.hi < found.best_hi;
    if (OVC_CERTIFY != 0) {
        float lo = better ? found.best_lo : c.lo; // the one of the two that is not the best
        add_further(found, possible ? lo : OVC_NEVER, better ? found.prim : prim);
    }
    found.best_lo = better ? c.lo : found.best_lo;
    found.best_hi = better ? c.hi : found.best_hi;
    found.prim = better ? prim : found.prim;
    found.weights = better ? c.weights : found.weights;
    found.order = better ? order : found.order;
    return better;
}

// Takes the triangle (a, b, c) in. Returns true when it is now the best.
bool take(inout Found found, Corner a, Corner b, Corner c, Edges e, Depths depths, bool valid,
          uint prim, uint order) {
    return take(found, candidate(a, b, c, e, depths), valid, prim, order);
}

// A triangle that planes cut comes once for each of its parts, within a page and in others. It is
// not a second candidate.
bool is_known(Found found, uint prim) { return prim == found.prim; }

// Returns u and v of the triangle's own corners, from the weights of the pair's: order says which
// of its corners v0 and v2 are.
vec2 barycentric(Found found) {
    uint first = found.order & 3u;
    uint last = (found.order >> 2) & 3u;
    float weight = 1.0 - found.weights.x - found.weights.y;
    float u = first == 1u ? weight : (last == 1u ? found.weights.y : found.weights.x);
    float v = first == 2u ? weight : (last == 2u ? found.weights.y : found.weights.x);
    return vec2(u, v);
}

bool has_hit(Found found) { return found.prim != OVC_MISS; }

#if OVC_PORTALS
// Returns the same in another frame, rounded outwards. t_end: the ray's end there.
Found in_times(Found found, Times from, Times to, float t_end) {
    bool hit = has_hit(found);
    Found there = found;
    there.best_lo = hit ? earlier(found.best_lo, from, to) : OVC_NEVER;
    there.best_hi = hit ? later(found.best_hi, from, to) : t_end;
    for (int i = 0; i < 2; ++i) {
        bool counts =
            found.further_lo[i] < OVC_NEVER && !(hit && found.further_lo[i] > found.best_hi);
        there.further_lo[i] = counts ? earlier(found.further_lo[i], from, to) : OVC_NEVER;
    }
    bool others = found.others_lo < OVC_NEVER && !(hit && found.others_lo > found.best_hi);
    there.others_lo = others ? earlier(found.others_lo, from, to) : OVC_NEVER;
    return there;
}
#endif

// A further candidate counts unless it certainly lies beyond this. Without a hit, best_hi is the
// end of the part that the ray met last, while the further candidates are from all parts.
float end_of_candidates(Found found) {
    return OVC_PORTALS != 0 && !has_hit(found) ? 0.5 * OVC_NEVER : found.best_hi;
}

// Returns whether so many candidates count that none can be named.
bool are_too_many(Found found) { return found.others_lo <= end_of_candidates(found); }

// The words of an answer from `leaf`.
uvec4 answer_of(Found found, bool any_hit, uint leaf) {
    if (OVC_CERTIFY == 0 || (any_hit && found.prim != OVC_MISS))
        return uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, leaf, found.prim);
    float end = end_of_candidates(found);
    uint first = found.further_lo[0] <= end ? found.further[0] : OVC_NO_TRIANGLE;
    uint second = found.further_lo[1] <= end ? found.further[1] : OVC_NO_TRIANGLE;
#if OVC_PORTALS
    // A triangle may be in doubt in one part and certain in another.
    second = second == found.prim ? OVC_NO_TRIANGLE : second;
    first = first == found.prim ? second : first;
    second = first == second ? OVC_NO_TRIANGLE : second;
#endif
    return uvec4(first, second, leaf, are_too_many(found) ? OVC_FLAGGED : found.prim);
}
