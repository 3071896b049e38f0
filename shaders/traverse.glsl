// SPDX-License-Identifier: Apache-2.0
// The traversal of a tree of units. A round is a step to a node, then a step to a node or a triangle pair: where both halves of
// a step run whatever is asked (llvmpipe), pairs, a seventh of the steps, then cost half the rounds instead of all.
// Based on: thesis, section 3.1 (a BVH in a texture); Ylitie et al. 2017 (one stack word per node); Laine 2010.

// Of a ray, what is the same in every leaf's frame. dir: the largest component 1 or -1.
struct Direction {
    vec3 inv_dir;
    Basis basis;
};

Direction direction_of(vec3 dir) { return Direction(finite_reciprocal(dir), basis_of(dir)); }

// The four texels of a unit (layout.h).
struct Unit {
    uvec4 x;
    uvec4 y;
    uvec4 z;
    uvec4 w;
};

Unit unit_at(int unit) {
    int at = unit * OVC_UNIT_TEXELS;
    return Unit(page_texel(at), page_texel(at + 1), page_texel(at + 2), page_texel(at + 3));
}

bool is_pair(Unit unit) { return int(unit.w.w) < 0; }

// Where a ray is in the tree. A stack word is a node with children still to come: the unit of the first of its children << 8,
// how many are to come << 6, and their numbers, two bits each, the next one lowest; 0 is no word.
struct Descent {
    int unit;   // where it goes next
    int top;    // the word on top of the stack; 0: the stack is empty
    int height; // of the words below `top`, less one
    int stack[OVC_STACK_DEPTH];
    bool done;
};

// Goes down to the nearest of the children that `keys` has; where it has none, and `leave`, to the next of the stack.
void advance(inout Descent d, int first_child, ivec4 keys, bool leave) {
    sort_keys(keys);
    bool descend = keys.x != OVC_NO_CHILD;
    ivec3 met = mix(ivec3(1), ivec3(0), equal(keys.yzw, ivec3(OVC_NO_CHILD)));
    int others = met.x + met.y + met.z;
    int word = (first_child << 8) | (others << 6) | (keys.y & 3) | ((keys.z & 3) << 2) | ((keys.w & 3) << 4);
    bool push = others != 0;
    bool back = leave && !descend;

    int left = (d.top >> 6) & 3;
    int rest = (d.top & ~255) | ((left - 1) << 6) | ((d.top & 63) >> 2);
    d.done = d.done || (back && left == 0);
    d.unit = descend ? first_child + (keys.x & 3) : (back ? (d.top >> 8) + (d.top & 3) : d.unit);

    bool store = push && d.top != 0;
    bool pop = back && left <= 1;
    int below = 0;
#if OVC_STACK_REGISTERS
    // One comparison serves both ways: nobody reads the slot again that a word was popped from.
    int slot = store ? d.height + 1 : (pop ? d.height : -1);
    for (int i = 0; i < OVC_STACK_DEPTH; ++i) {
        below = slot == i ? d.stack[i] : below;
        d.stack[i] = slot == i ? d.top : d.stack[i];
    }
#else
    if (store)
        d.stack[d.height + 1] = d.top;
    if (pop && d.height >= 0)
        below = d.stack[d.height];
#endif
    d.height += store ? 1 : (pop && d.height >= 0 ? -1 : 0);
    d.top = push ? word : (pop ? below : (back ? rest : d.top));
}

#if OVC_TELL_ACTIVE && OVC_LINKED
void tell_active(Unit unit, bool here) {
    if (here && unit.w.y != 0u)
        mark_active(int(unit.w.y) - 1);
}
#else
void tell_active(Unit unit, bool here) {}
#endif

// Takes into `found` what the ray may hit in the page whose header is the pool's unit `page`, and whose units count from the unit
// `first_unit`. False: the loop was ended before it was done. rounds: of all loops of this ray so far.
bool traverse(inout Found found, int page, int first_unit, vec3 org, float t_end, Direction direction, uint skip, bool any_hit,
              inout int rounds) {
    int header = page * OVC_UNIT_TEXELS;
    GridRay grid = grid_ray(org, direction.inv_dir, uintBitsToFloat(page_texel(header).xyz), uintBitsToFloat(page_texel(header + 1).xyz));

    // Fetched, because a compiler that knows the first values splits the loop's variables into masked copies (llvmpipe).
    ivec4 first = ivec4(page_texel(header + 2));
    Descent d;
    d.unit = first.x;
    d.height = first.y;
    d.top = first.z;
    for (int i = 0; i < OVC_STACK_DEPTH; ++i)
        d.stack[i] = first.z;

    // Tested at the top, and fetched as well: llvmpipe (22.3) keeps, behind a loop, only what was known at its top for lanes
    // that left early; what the rest of the body computed it computes again, for the lanes that go on.
    d.done = first.w != 0;
    while (!d.done && rounds < OVC_MOST_ROUNDS) {
#if OVC_BRANCHES
        Unit unit = unit_at(first_unit + d.unit);
        bool took = false;
        ivec4 keys = ivec4(OVC_NO_CHILD);
        if (is_pair(unit)) {
            took = take_pair(found, unit.x, unit.y, unit.z, unit.w, true, org, direction.basis, skip);
        } else {
            tell_active(unit, true);
            keys = child_keys(unit.x, unit.y, unit.z, grid, found.best_hi);
        }
        advance(d, int(unit.w.x), keys, true);
#else
        Unit node = unit_at(first_unit + d.unit);
        bool here = !is_pair(node); // a pair waits for the second step
        tell_active(node, here);
        // A pair's bits mean nothing as boxes: an end before the beginning lets none of them through.
        advance(d, int(node.w.x), child_keys(node.x, node.y, node.z, grid, here ? found.best_hi : -1.0), here);

        Unit unit = unit_at(first_unit + d.unit);
        bool pair = is_pair(unit) && !d.done;
        here = !is_pair(unit) && !d.done;
        tell_active(unit, here);
        ivec4 keys = child_keys(unit.x, unit.y, unit.z, grid, here ? found.best_hi : -1.0);
        bool took = take_pair(found, unit.x, unit.y, unit.z, unit.w, pair, org, direction.basis, skip);
        advance(d, int(unit.w.x), keys, true);
#endif
        d.done = d.done || (any_hit && took);
        ++rounds;
    }
    return d.done;
}
