// SPDX-License-Identifier: Apache-2.0
// The traversal of one page: one loop in which a step is an inner node or a triangle pair, the same instructions for both.
// Based on: thesis, section 3.1 (a BVH in a texture); Ylitie et al. 2017 (one stack word per node); Laine 2010.

// A stack word: unit of the first child << 8, children left << 6, their numbers two bits each, next one lowest.
int stack_word(int base, ivec4 keys, int left) {
    return (base << 8) | (left << 6) | (keys.y & 3) | ((keys.z & 3) << 2) | ((keys.w & 3) << 4);
}

// Of a ray, what is the same in every leaf's frame. dir: the largest component 1 or -1.
struct Direction {
    vec3 inv_dir;
    Basis basis;
};

Direction direction_of(vec3 dir) { return Direction(finite_reciprocal(dir), basis_of(dir)); }

// Takes into `found` what the ray may hit in the page whose header is the pool's unit `page`, and whose units count from the unit
// `first_unit`. False: the loop was ended before it was done. rounds: of all loops of this ray so far.
bool traverse(inout Found found, int page, int first_unit, vec3 org, float t_end, Direction direction, uint skip, bool any_hit,
              inout int rounds) {
    int header = page * OVC_UNIT_TEXELS;
    GridRay grid = grid_ray(org, direction.inv_dir, uintBitsToFloat(page_texel(header).xyz), uintBitsToFloat(page_texel(header + 1).xyz));

    // Fetched, because a compiler that knows the first values splits the loop's variables into masked copies (llvmpipe).
    ivec4 first = ivec4(page_texel(header + 2));
    int unit = first.x;
    int top = first.y; // the word on top of the stack; negative: empty
    int height = first.z;
    int stack[OVC_STACK_DEPTH];
    for (int i = 0; i < OVC_STACK_DEPTH; ++i)
        stack[i] = first.y;

    // Tested at the top, and fetched as well: llvmpipe (22.3) keeps, behind a loop, only what was known at its top for lanes
    // that left early; what the rest of the body computed it computes again, for the lanes that go on.
    bool done = first.w != 0;
    while (!done && rounds < OVC_MOST_ROUNDS) {
        int at = (first_unit + unit) * OVC_UNIT_TEXELS;
        uvec4 X = page_texel(at);
        uvec4 Y = page_texel(at + 1);
        uvec4 Z = page_texel(at + 2);
        uvec4 W = page_texel(at + 3);
        bool is_pair = int(W.w) < 0;
#if OVC_TELL_ACTIVE && OVC_LINKED
        if (!is_pair && W.y != 0u)
            mark_active(int(W.y) - 1);
#endif

        // A pair's bits mean nothing as boxes: an end before the beginning lets none of them through.
        ivec4 keys = child_keys(X, Y, Z, grid, is_pair ? -1.0 : found.best_hi);
        sort_keys(keys);
        bool took = take_pair(found, X, Y, Z, W, is_pair, org, direction.basis, skip);

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
        ++rounds;
    }
    return done;
}
