// SPDX-License-Identifier: Apache-2.0
// The traversal of a tree of units. A round is a step to a node, then a step to a node or a
// triangle pair. llvmpipe runs both halves of a step whatever is asked; pairs, a seventh of the
// steps, then cost half the rounds instead of all.
// Based on: thesis, section 3.1 (a BVH in a texture); Ylitie et al. 2017 (one stack word per node);
// Laine 2010.

// A ray's direction, which is the same in every leaf's frame; its largest component is 1 or -1.
struct Direction {
    vec3 inv_dir;
    Axes axes;
    vec2 shear;
};

Direction direction_of(vec3 dir, Axes axes) {
    return Direction(finite_reciprocal(dir), axes, by_axis(axes, dir).xy);
}
Direction direction_of(vec3 dir) { return direction_of(dir, axes_of(dir)); }

// A stack word is a node with children still to come: the unit of its first child, and the numbers
// of the children to come in seven bits, two each, the next one lowest, below a 1; 0 is no word.
#if OVC_POOL_BUFFERS == 1
#define Word uint
Word word_of(int first_child, int to_come) { return uint(first_child << 7 | to_come); }
int first_child_of(Word word) { return int(word >> 7); }
uint to_come_of(Word word) { return word & 127u; }
Word with_to_come(Word word, uint to_come) { return (word & ~127u) | to_come; }
#else
#define Word uvec2
Word word_of(int first_child, int to_come) { return uvec2(first_child, to_come); }
int first_child_of(Word word) { return int(word.x); }
uint to_come_of(Word word) { return word.y; }
Word with_to_come(Word word, uint to_come) { return uvec2(word.x, to_come); }
#endif
bool is_none(Word word) { return to_come_of(word) == 0u; }

#if OVC_STACK == 2
shared Word stack_words[OVC_STACK_DEPTH * OVC_GROUP_SIZE]; // neighbouring lanes in different banks
#define OVC_STACK_AT(d, i) stack_words[(i) * OVC_GROUP_SIZE + int(gl_LocalInvocationIndex)]
#else
#define OVC_STACK_AT(d, i) d.stack[i]
#endif

// Where a ray is in the tree.
struct Descent {
    int unit;   // to go to next; under portals 0: the top-level tree; negative: the portal -unit
    Word top;   // the word on top of the stack; none: the stack is empty
    int height; // of the words below `top`, less one, unless they are in registers
#if OVC_STACK != 2
    Word stack[OVC_STACK_DEPTH]; // in registers the first is the word below `top`
#endif
    bool done;
    bool lost; // the stack was too short, so the ray may have missed triangles
};

// Returns whether the ray goes on in this tree, and not to a portal.
bool goes_on(Descent d) { return OVC_PORTALS == 0 || d.unit >= 0; }

// Returns whether the ray has come to a portal, and looks for something still.
bool is_at_portal(Descent d, Found found) {
    return !goes_on(d) && !d.lost && found.best_hi >= 0.0;
}

// Goes down to the first of the children; if there is none, and `leave`, to the next of the stack.
void advance(inout Descent d, int first_child, Children children, bool leave) {
    Way way = way_to(children);
    bool back = leave && !way.down;
    Word word = word_of(first_child, way.others);

    uint to_come = to_come_of(d.top);
    Word rest = with_to_come(d.top, to_come >> 2);
    d.unit = way.down ? first_child + way.first
                      : (back ? first_child_of(d.top) + int(to_come & 3u) : d.unit);

    bool empty = is_none(d.top);
    bool store = way.more && !empty;
    bool pop = back && (to_come & 0x70u) == 0u; // no more than one was to come
    Word below;
#if OVC_STACK == 1
    // All words move: that takes two selections a word and no comparison.
    below = d.stack[0];
    d.lost = d.lost || (store && !is_none(d.stack[OVC_STACK_DEPTH - 1]));
    Word above = d.top;
    for (int i = 0; i < OVC_STACK_DEPTH; ++i) {
        Word own = d.stack[i];
        Word next = i + 1 < OVC_STACK_DEPTH ? d.stack[i + 1] : Word(0u);
        d.stack[i] = store ? above : (pop ? next : own);
        above = own;
    }
#else
    d.lost = d.lost || (store && d.height >= OVC_STACK_DEPTH - 1);
    below = Word(0u);
    if (store && !d.lost)
        OVC_STACK_AT(d, d.height + 1) = d.top;
    if (pop && d.height >= 0)
        below = OVC_STACK_AT(d, d.height);
    d.height += store ? 1 : (pop && d.height >= 0 ? -1 : 0);
#endif
    d.top = way.more ? word : (pop ? below : (back ? rest : d.top));
    d.done = d.done || (back && empty) || d.lost;
}

#if OVC_TELL_ACTIVE && !OVC_MAY_WAIT
void tell_active(Unit unit, bool here) {
    if (here && unit.w.y != 0u)
        mark_active(int(unit.w.y) - 1);
}
#else
void tell_active(Unit unit, bool here) {}
#endif

// The links on a ray's way, by their keys (layout.h): the ray is done with those below `done`, and
// waits for the first of the others that leads nowhere.
struct Links {
    int done;
    int waits;
};

Links no_links() { return Links(0, OVC_NO_CHILD); }

#if OVC_MAY_WAIT
// Returns the children of `unit` that a ray goes down to: none if it is a link that the ray is done
// with, or one beyond the link that it waits for.
Children follow(inout Links links, Unit unit, Stretches s, Place place) {
    ivec4 entered = entries(s);
    int first = min(min(entered.x, entered.y), min(entered.z, entered.w));
    bool link = unit.w.y != 0u;
    int key = (not_after(place, max(first, 0)) & ~OVC_KEY_LEAF) | int(unit.w.y);
    bool open = link && first != OVC_NO_CHILD && key >= links.done && key < links.waits;
    bool nowhere = int(unit.w.x) == OVC_LEADS_NOWHERE;
    links.waits = open && nowhere ? key : links.waits;
#if OVC_TELL_ACTIVE
    if (open && !nowhere)
        mark_active(int(unit.w.y) - 1);
#endif
    return children_met(link && (!open || nowhere) ? ivec4(OVC_NO_CHILD) : entered);
}
#else
Children follow(inout Links links, Unit unit, Stretches s, Place place) {
    return children_met(s);
}
#endif

// Rays that go through a tree together, so that the kernel fetches, decodes and sorts a node once
// for all of them.
struct Packet {
    bvec3 backward; // where the directions of all rays are negative
    Axes axes;      // all rays go farthest along the same axis
    vec3 org[OVC_PACKET]; // by axis
    vec2 shear[OVC_PACKET];
    GridRay grid[OVC_PACKET];
    uint first_number; // of the first triangle of the part
    uint skip[OVC_PACKET];
    bool any_hit[OVC_PACKET];
    Links links[OVC_PACKET];
    Place place;
};

// The header of a tree: of a page, of the top-level tree, or of a part of it.
struct Tree {
    vec3 grid_middle;
    vec3 grid_cell;
    // Fetched, because a compiler that knows the first values splits a loop's variables into masked
    // copies (llvmpipe).
    ivec4 start;
    int first_unit; // units count from here
};

// Returns the tree whose header is the pool's unit `page`.
Tree tree_of(int page, int first_unit) {
    Unit header = unit_at(page);
    return Tree(uintBitsToFloat(header.x.xyz), uintBitsToFloat(header.y.xyz), ivec4(header.z),
                first_unit);
}

void set_ray(inout Packet packet, int k, Tree tree, vec3 org, Direction direction, uint skip,
             bool any_hit) {
    packet.org[k] = by_axis(packet.axes, org);
    packet.shear[k] = direction.shear;
    packet.grid[k] = grid_ray(org, direction.inv_dir, tree.grid_middle, tree.grid_cell);
    packet.skip[k] = skip;
    packet.any_hit[k] = any_hit;
}

void start(inout Descent d, Tree tree) {
    d.unit = tree.start.x;
    d.height = tree.start.y;
#if OVC_STACK == 1
    for (int i = 0; i < OVC_STACK_DEPTH; ++i)
        d.stack[i] = Word(tree.start.z);
#endif
    d.top = Word(tree.start.z);
    d.done = tree.start.w != 0;
    d.lost = tree.start.w != 0;
}

Descent descent(Tree tree) {
    Descent d;
    start(d, tree);
    return d;
}

#if OVC_PORTALS
bvec3 backward_of(Packet packet) {
    bvec3 here = packet.backward, there = packet.place.backward;
    bool behind = packet.place.behind_portal;
    return bvec3(behind ? here.x : there.x, behind ? here.y : there.y, behind ? here.z : there.z);
}
GridRay grid_of(Packet packet, int k) {
    bool behind = packet.place.behind_portal;
    return GridRay(behind ? packet.grid[k].scale : packet.place.grid.scale,
                   behind ? packet.grid[k].offset : packet.place.grid.offset);
}
float end_of(Packet packet, Found found, int k) {
    return packet.place.behind_portal ? found.best_hi : packet.place.end;
}

// Takes a ray back from a part if `back`: its hit there ends it in the top-level tree.
void leave(inout Place place, Found found, bool back) {
    float end = greater(place.not_before.x + found.best_hi * place.not_before.y, 0.0);
    place.end =
        back && place.behind_portal && has_hit(found) ? lesser(place.end, end) : place.end;
    place.behind_portal = place.behind_portal && !back;
}
#else
bvec3 backward_of(Packet packet) { return packet.backward; }
GridRay grid_of(Packet packet, int k) { return packet.grid[k]; }
float end_of(Packet packet, Found found, int k) { return found.best_hi; }
#endif

// Returns the children of the node that any ray of the packet meets. If not `here`, the unit is a
// pair or a header, whose bits mean nothing as boxes, and no ray meets any.
Children children_of(Unit node, inout Packet packet, Found found[OVC_PACKET], bool here) {
    Boxes boxes = boxes_of(node.x, node.y, node.z, backward_of(packet));
    Children children = no_children();
    for (int k = 0; k < OVC_PACKET; ++k) {
        int end = here ? floatBitsToInt(end_of(packet, found[k], k)) : OVC_NO_END;
        add(children,
            follow(packet.links[k], node, stretches(boxes, grid_of(packet, k), end), packet.place));
    }
#if OVC_PORTALS
    children = joined(children, int(node.w.x) < 0); // the boxes of a portal's node
#endif
    return children;
}

// If `here`, tests the pair with the rays that still look for something.
void take_pairs(inout Found found[OVC_PACKET], Unit pair, Packet packet, bool here) {
    for (int k = 0; k < OVC_PACKET; ++k) {
        bool took = take_pair(found[k], pair.x, pair.y, pair.z, pair.w,
                              here && found[k].best_hi >= 0.0,
                              Line(packet.axes, packet.org[k], packet.shear[k]), packet.skip[k],
                              packet.first_number);
        found[k].best_hi = packet.any_hit[k] && took ? OVC_ENOUGH : found[k].best_hi;
#if !OVC_REFILL
        end_behind_candidates(found[k], packet.any_hit[k]);
#endif
    }
}

bool all_have_enough(Found found[OVC_PACKET]) {
    bool all = true;
    for (int k = 0; k < OVC_PACKET; ++k)
        all = all && found[k].best_hi < 0.0;
    return all;
}

// Returns whether a ray comes back from a part: it then reaches unit 0, a header, which push_mark()
// has put below the part's words on the stack.
bool comes_back(inout Descent d, inout Packet packet, Found found[OVC_PACKET]) {
#if OVC_PORTALS
    bool back = d.unit == 0;
    leave(packet.place, found[0], back);
    return back;
#else
    return false;
#endif
}

Unit unit_of(Descent d, int first_unit) {
    return unit_at(OVC_PORTALS == 0 ? first_unit + d.unit : max(d.unit, 0));
}

void go_round(inout Descent d, inout Found found[OVC_PACKET], inout Packet packet,
              int first_unit) {
#if OVC_BRANCHES
    Unit unit = unit_of(d, first_unit);
    Children children = no_children();
    bool back = comes_back(d, packet, found);
    if (is_pair(unit)) {
        take_pairs(found, unit, packet, true);
    } else {
        tell_active(unit, true);
        children = children_of(unit, packet, found, !back);
    }
    advance(d, int(unit.w.x), children, goes_on(d));
#else
    Unit node = unit_of(d, first_unit);
    bool here = !is_pair(node); // a pair waits for the second step
    bool back = comes_back(d, packet, found);
    tell_active(node, here);
    advance(d, int(node.w.x), children_of(node, packet, found, here && !back), here);

    // A ray that is done by now goes to unit 0, a header, which has neither pairs nor links.
    Unit unit = unit_of(d, first_unit);
    bool pair = is_pair(unit);
    back = comes_back(d, packet, found);
    tell_active(unit, !pair);
    Children children = children_of(unit, packet, found, !pair && !back && goes_on(d));
#if OVC_PACKET > 1
    take_pairs(found, unit, packet, pair);
    advance(d, int(unit.w.x), children, goes_on(d));
#else
    // One ray knows its way before its pairs are tested, so its next fetch begins while they are.
    // That saves 5 % of the time; two rays do not gain from it.
    advance(d, int(unit.w.x), children, goes_on(d));
    take_pairs(found, unit, packet, pair);
#endif
#endif
    d.done = d.done || !goes_on(d) || all_have_enough(found);
}

// Takes into `found` the triangles that the rays may hit: for at least one round, until they are
// done or `rounds` reaches max_rounds. Returns whether they are done, for good or because the stack
// lost something.
bool run(inout Descent d, inout Found found[OVC_PACKET], inout Packet packet, int first_unit,
         int max_rounds, inout int rounds) {
    // The loop is tested at the bottom, because llvmpipe (22.3) goes through the body once more
    // when a test at the top finds no lane left. For a ray that was done before, a round finds
    // nothing.
    bool on;
    do {
        go_round(d, found, packet, first_unit);
        ++rounds;
        on = !d.done && rounds < max_rounds;
    } while (on);
    return d.done;
}

#if OVC_PACKET == 1
// Traces one ray until its end in the page whose header is the pool's unit `page`; units count from
// there. Returns false if the ray was ended before; `rounds` is then OVC_MAX_ROUNDS, so that the
// caller's loop ends as well.
bool traverse(inout Found found, int page, vec3 org, Direction direction, uint skip, bool any_hit,
              inout int rounds) {
    Tree tree = tree_of(page, page);
    Descent d = descent(tree);
    Packet packet;
    packet.links[0] = no_links();
    packet.first_number = 0u;
    packet.backward = lessThan(direction.inv_dir, vec3(0.0));
    packet.axes = direction.axes;
    set_ray(packet, 0, tree, org, direction, skip, any_hit);
    Found one[1] = Found[1](found);
    bool ended = run(d, one, packet, tree.first_unit, OVC_MAX_ROUNDS, rounds);
    found = one[0];
    ended = ended && !d.lost;
    rounds = ended ? rounds : OVC_MAX_ROUNDS;
    return ended;
}
#endif
