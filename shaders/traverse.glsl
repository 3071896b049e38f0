// SPDX-License-Identifier: Apache-2.0
// The traversal of one page: one loop in which a step is an inner node or a triangle pair, the same instructions for both.
// Based on: thesis, section 3.1 (a BVH in a texture); Ylitie et al. 2017 (one stack word per node); Laine 2010.

struct Answer {
    float t;
    vec2 uv;
    uint prim;
};

// What the traversal knows so far. A certain hit in [best_lo, best_hi]; anything else that may be hit at `doubt` or later.
struct Found {
    float best_lo;
    float best_hi;
    float doubt;
    uint prim;
    vec2 weights; // of the pair's corners that are not v0; with `order` they become u and v
    uint order;
};

const float OVC_NEVER = 3.0e38;

// Takes a candidate in. Returns true when it is now the best.
bool take(inout Found found, Candidate c, bool valid, uint prim, uint order) {
    bool possible = valid && c.possible && c.hi >= 0.0;
    bool better = possible && c.certain && (c.lo > 0.0 || OVC_CERTIFY == 0) && c.hi < found.best_hi;
    float rival = better ? found.best_lo : c.lo;
    found.doubt = possible ? min(found.doubt, rival) : found.doubt;
    found.best_lo = better ? c.lo : found.best_lo;
    found.best_hi = better ? c.hi : found.best_hi;
    found.prim = better ? prim : found.prim;
    found.weights = better ? c.weights : found.weights;
    found.order = better ? order : found.order;
    return better;
}

// The weights of the pair's corners as u and v of the triangle's own: order says which of its corners v0 and v2 are.
vec2 barycentric(Found found) {
    uint first = found.order & 3u;
    uint last = (found.order >> 2) & 3u;
    float weight = 1.0 - found.weights.x - found.weights.y;
    float u = first == 1u ? weight : (last == 1u ? found.weights.y : found.weights.x);
    float v = first == 2u ? weight : (last == 2u ? found.weights.y : found.weights.x);
    return vec2(u, v);
}

bool take_pair(inout Found found, uvec4 X, uvec4 Y, uvec4 Z, uvec4 W, bool is_pair, vec3 org, Basis basis,
               uint skip) {
    Corner v0 = corner(uintBitsToFloat(X.xyz), org, basis);
    Corner v1 = corner(uintBitsToFloat(Y.xyz), org, basis);
    Corner v2 = corner(uintBitsToFloat(Z.xyz), org, basis);
    Corner v3 = corner(uintBitsToFloat(W.xyz), org, basis);
    float e20 = edge(v2, v0);
    float e20_error = edge_error(v2, v0);
    Candidate a = candidate(v0, v1, v2, edge(v0, v1), edge(v1, v2), e20, edge_error(v0, v1),
                            edge_error(v1, v2), e20_error);
    Candidate b = candidate(v0, v3, v2, edge(v0, v3), edge(v3, v2), e20, edge_error(v0, v3),
                            edge_error(v3, v2), e20_error);
    bool took_a = take(found, a, is_pair && X.w != skip, X.w, Z.w);
    bool took_b = take(found, b, is_pair && Y.w != skip && Y.w != OVC_NO_TRIANGLE, Y.w, Z.w >> 4);
    return took_a || took_b;
}

// A stack word: unit of the first child << 8, children left << 6, their numbers two bits each, next one lowest.
int stack_word(int base, ivec4 keys, int left) {
    return (base << 8) | (left << 6) | (keys.y & 3) | ((keys.z & 3) << 2) | ((keys.w & 3) << 4);
}

Answer trace(vec3 org, float t_end, vec3 dir, uint skip) {
    const bool any_hit = OVC_ANY_HIT != 0;
    Found found = Found(OVC_NEVER, t_end, OVC_NEVER, OVC_MISS, vec2(0.0), 8u);
    GridRay grid = grid_ray(org, dir, uintBitsToFloat(page_texel(0).xyz), uintBitsToFloat(page_texel(1).xyz));
    Basis basis = basis_of(dir);

    // Fetched, because a compiler that knows the first values splits the loop's variables into masked copies (llvmpipe).
    ivec4 first = ivec4(page_texel(2));
    int unit = first.x;
    int top = first.y; // the word on top of the stack; negative: empty
    int height = first.z;
    int stack[OVC_STACK_DEPTH];
    for (int i = 0; i < OVC_STACK_DEPTH; ++i)
        stack[i] = first.y;

    bool done = t_end < 0.0;
    if (!done)
        for (;;) {
            int at = unit * OVC_UNIT_TEXELS;
            uvec4 X = page_texel(at);
            uvec4 Y = page_texel(at + 1);
            uvec4 Z = page_texel(at + 2);
            uvec4 W = page_texel(at + 3);
            bool is_pair = int(W.w) < 0;

            // A pair's bits mean nothing as boxes: an end before the beginning lets none of them through.
            ivec4 keys = child_keys(X, Y, Z, grid, is_pair ? -1.0 : found.best_hi);
            sort_keys(keys);
            bool took = take_pair(found, X, Y, Z, W, is_pair, org, basis, skip);

            bool descend = keys.x != OVC_NO_CHILD;
            ivec3 hits = mix(ivec3(0), ivec3(1), notEqual(keys.yzw, ivec3(OVC_NO_CHILD)));
            int left = hits.x + hits.y + hits.z;
            bool push = descend && left > 0;
            int top_left = (top >> 6) & 3;
            bool pop = !descend && top_left == 1; // the last child of the top word
            done = (!descend && top < 0) || (any_hit && took);

            unit = descend ? int(W.x) + (keys.x & 3) : (top >> 8) + (top & 3);
            int advanced = (top & ~255) | ((top_left - 1) << 6) | ((top & 63) >> 2);
#if OVC_STACK_REGISTERS
            int slot = push ? height : -1;
            for (int i = 0; i < OVC_STACK_DEPTH; ++i)
                stack[i] = slot == i ? top : stack[i];
            height += push ? 1 : (pop ? -1 : 0);
            int below = stack[0];
            for (int i = 1; i < OVC_STACK_DEPTH; ++i)
                below = height == i ? stack[i] : below;
#else
            if (push)
                stack[height] = top;
            height += push ? 1 : (pop ? -1 : 0);
            int below = stack[clamp(height, 0, OVC_STACK_DEPTH - 1)];
#endif
            top = push ? stack_word(int(W.x), keys, left) : (pop ? below : (descend ? top : advanced));
            if (done)
                break;
        }

    // llvmpipe ends a loop after 65535 rounds without a word: such a ray is not done, and nobody may believe it.
    bool certain = OVC_CERTIFY == 0 || (any_hit && found.prim != OVC_MISS);
    bool flagged = !done || (!certain && found.doubt <= found.best_hi);
    vec2 uv = OVC_CERTIFY == 0 ? barycentric(found) : vec2(0.0);
    return Answer(0.5 * (found.best_lo + found.best_hi), uv, flagged ? OVC_FLAGGED : found.prim);
}
