// SPDX-License-Identifier: Apache-2.0
// Decides which children of a node a ray, or any ray of a packet, goes down to, and in which order.

struct Way {
    bool down;  // there is one
    int first;  // the number of the one to go to now
    bool more;  // there are others
    int others; // their numbers, two bits each, the next one lowest, below a 1
};

#if OVC_ANY_HIT
// Goes to the children in the order of their numbers: the packer puts the largest first
// (gpu/page/packer.h). Going to the nearest first found a hit no sooner.
struct Children {
    bvec4 met;
};

Children no_children() { return Children(bvec4(false)); }

void add(inout Children children, Children c) {
    bvec4 a = children.met, b = c.met;
    children.met = bvec4(a.x || b.x, a.y || b.y, a.z || b.z, a.w || b.w);
}

Children children_met(Stretches s) { return Children(lessThan(s.enter, s.exit)); }
Children children_met(ivec4 entries) { return Children(lessThan(entries, ivec4(OVC_NO_CHILD))); }

// Makes one child, the first, of those that the ray meets, if `all` are the same.
Children joined(Children children, bool all) {
    bvec4 met = children.met;
    bool others = met.y || met.z || met.w;
    return Children(bvec4(met.x || (all && others), !all && met.y, !all && met.z, !all && met.w));
}

Way way_to(Children children) {
    int list = children.met.w ? 7 : 1;
    list = children.met.z ? list << 2 | 2 : list;
    list = children.met.y ? list << 2 | 1 : list;
    list = children.met.x ? list << 2 : list;
    return Way(list > 1, list & 3, list > 7, list >> 2);
}
#else
// The nearest child comes first. A key tells where the ray enters the child, as entries() does.
struct Children {
    ivec4 keys;
};

Children no_children() { return Children(ivec4(OVC_NO_CHILD)); }

void add(inout Children children, Children c) { children.keys = min(children.keys, c.keys); }

Children children_met(Stretches s) { return Children(entries(s)); }
Children children_met(ivec4 entries) { return Children(entries); }

void order(inout int a, inout int b) {
    int low = min(a, b);
    b = max(a, b);
    a = low;
}

// Makes one child, the first, of those that the ray meets, if `all` are the same.
Children joined(Children children, bool all) {
    ivec4 k = children.keys;
    int first = min(min(k.x, k.y), min(k.z, k.w));
    return Children(all ? ivec4(first, OVC_NO_CHILD, OVC_NO_CHILD, OVC_NO_CHILD) : k);
}

// Sorts by a network of five comparisons, with each child's number in the two lowest bits.
Way way_to(Children children) {
    ivec4 k = (children.keys & ~3) | ivec4(0, 1, 2, 3);
    order(k.x, k.y);
    order(k.z, k.w);
    order(k.x, k.z);
    order(k.y, k.w);
    order(k.y, k.z);
    int second = (k.y & 3) | 4;
    int third = (k.y & 3) | (k.z & 3) << 2 | 16;
    int fourth = (k.y & 3) | (k.z & 3) << 2 | (k.w & 3) << 4 | 64;
    int others = k.w < OVC_NO_CHILD ? fourth : (k.z < OVC_NO_CHILD ? third : second);
    return Way(k.x < OVC_NO_CHILD, k.x & 3, k.y < OVC_NO_CHILD, others);
}
#endif
