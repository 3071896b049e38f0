// SPDX-License-Identifier: Apache-2.0
// What a traversal knows so far about the nearest hit: the best certain hit, and the candidates
// that might still be nearer (docs/design/numerics.md).

const float OVC_NEVER = 3.0e38;

// A certain hit in [best_lo, best_hi], and the further candidates: triangles that may be hit, but
// not certainly farther than the best. The last OVC_NAMES are named, the last one first; of all
// together it is known where they may be hit.
struct Found {
    float best_lo;
    float best_hi;
    uint prim;
    float further_lo;
    float further_hi;
    uint further[OVC_NAMES];
    int count; // of the further candidates
    // Fast precision of the thesis' systems: the weights of the pair's corners except v0, of which
    // `order` makes u and v.
    vec2 weights;
    uint order;
};

Found nothing_found(float t_end) {
    uint nobody[OVC_NAMES];
    for (int i = 0; i < OVC_NAMES; ++i)
        nobody[i] = OVC_NO_TRIANGLE;
    return Found(OVC_NEVER, t_end, OVC_MISS, OVC_NEVER, -OVC_NEVER, nobody, 0, vec2(0.0), 8u);
}

bool has_hit(Found found) { return found.prim != OVC_MISS; }

void add_further(inout Found found, bool valid, float lo, float hi, uint prim) {
    found.further_lo = lesser(valid ? lo : OVC_NEVER, found.further_lo);
    found.further_hi = greater(valid ? hi : -OVC_NEVER, found.further_hi);
    for (int i = OVC_NAMES - 1; i > 0; --i)
        found.further[i] = valid ? found.further[i - 1] : found.further[i];
    found.further[0] = valid ? prim : found.further[0];
    found.count += valid ? 1 : 0;
}

// Takes a candidate in. Returns true when it is now the best.
bool take(inout Found found, Candidate c, bool valid, uint prim, uint order) {
    bool possible = valid && c.possible && c.hi >= 0.0 && c.lo <= found.best_hi;
    // A triangle that planes cut, or that parts share, may be in doubt several times.
    bool named = (prim == found.further[0] && found.count > 0) ||
                 (prim == found.further[1] && found.count > 1);
    possible = possible && (c.certain || !named);
    bool better = possible && c.certain && (c.lo > 0.0 || OVC_CERTIFY == 0) &&
                  c.hi < found.best_hi;
    if (OVC_CERTIFY != 0) {
        bool behind = better && found.further_lo > c.hi; // the further candidates are
        found.further_lo = behind ? OVC_NEVER : found.further_lo;
        found.count = behind ? 0 : found.count;
        // The one of the two that is not the best.
        add_further(found, better ? found.best_lo <= c.hi : possible,
                    better ? found.best_lo : c.lo, better ? found.best_hi : c.hi,
                    better ? found.prim : prim);
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

#if OVC_PORTALS
// Returns the end of a ray behind its candidates in another frame. It is rounded inwards, for
// nobody has looked behind it in the frame before; but not to before a part that begins before the
// end: in a frame as large as the scene a rounding may be longer than the ray, and the part would
// be passed over. At the part's beginning the end is before the candidates, and the answer says so.
float end_in_times(float end, Times from, Times to) {
    float inwards = earlier(end, from, to);
    return later(end, from, to) >= 0.0 ? greater(inwards, 0.0) : inwards;
}

// Returns the same in another frame, rounded outwards. t_end: the ray's end there.
Found in_times(Found found, Times from, Times to, float t_end) {
    bool hit = has_hit(found);
    Found there = found;
    there.best_lo = hit && found.best_lo < OVC_NEVER ? earlier(found.best_lo, from, to) : OVC_NEVER;
    there.best_hi = hit ? later(found.best_hi, from, to) : t_end;
    if (found.prim == OVC_ENDED)
        there.best_hi = end_in_times(found.best_hi, from, to);
    // The end of a ray behind its candidates may be rounded to before them, and they count still.
    bool is_behind = hit && found.prim != OVC_ENDED && found.further_lo > found.best_hi;
    bool counts = found.count > 0 && !is_behind;
    there.count = counts ? found.count : 0;
    there.further_lo = counts ? earlier(found.further_lo, from, to) : OVC_NEVER;
    there.further_hi = counts ? later(found.further_hi, from, to) : -OVC_NEVER;
    there.further_hi = there.further_hi == OVC_UNDECIDABLE ? OVC_NEVER : there.further_hi;
    return there;
}
#endif

// A further candidate counts unless it certainly lies beyond this. Without a hit, best_hi is the
// end of the part that the ray met last, while the further candidates are from all parts.
float end_of_candidates(Found found) {
    return OVC_PORTALS != 0 && !has_hit(found) ? 0.5 * OVC_NEVER : found.best_hi;
}

bool do_candidates_count(Found found) { return found.further_lo <= end_of_candidates(found); }

// Returns whether so many candidates count that none can be named.
bool are_too_many(Found found) { return found.count > OVC_NAMES && do_candidates_count(found); }

#if OVC_NAMES > 2
// Returns whether more candidates count than the words of an answer can name.
bool are_listed(Found found) { return found.count > 2 && do_candidates_count(found); }
#endif

// Returns a t before which the ray certainly hits nothing.
float first_t(Found found) { return lesser(found.best_lo, found.further_lo); }

// Ends a ray with two further candidates behind them, because most such rays pass a side that both
// share, or a corner, and hit one of the triangles there. Doubles trace the others on. The end is
// farther behind the candidates than they are deep, so that it lies behind the others at a corner.
// It does not lie before the part where the ray is now: below 0 the ray would be done, and parts
// that it has not come to yet may reach to before its candidates.
void end_behind_candidates(inout Found found, bool any_hit) {
    float end = lesser(found.best_lo, found.best_hi);
    bool ends = OVC_CERTIFY != 0 && !any_hit && found.count > 1 && found.further_hi < end;
    float behind = found.further_hi + 3.0 * (found.further_hi - found.further_lo);
    found.best_lo = ends ? OVC_NEVER : found.best_lo;
    found.best_hi = ends ? greater(lesser(behind, end), 0.0) : found.best_hi;
    found.prim = ends ? OVC_ENDED : found.prim;
}

// The words of an answer from `leaf`.
uvec4 answer_of(Found found, bool any_hit, uint leaf) {
    if (OVC_CERTIFY == 0 || (any_hit && found.prim != OVC_MISS))
        return uvec4(OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, leaf, found.prim);
    bool counts = do_candidates_count(found);
    uint first = counts && found.count > 0 ? found.further[0] : OVC_NO_TRIANGLE;
    uint second = counts && found.count > 1 ? found.further[1] : OVC_NO_TRIANGLE;
#if OVC_PORTALS
    // A triangle may be in doubt in one part and certain in another.
    second = second == found.prim ? OVC_NO_TRIANGLE : second;
    first = first == found.prim ? second : first;
    second = first == second ? OVC_NO_TRIANGLE : second;
#endif
    // Behind the end of the ray there may be something nearer than such a candidate.
    bool beyond = found.prim == OVC_ENDED && found.further_hi > found.best_hi;
    return uvec4(first, second, leaf, are_too_many(found) || beyond ? OVC_FLAGGED : found.prim);
}
