// SPDX-License-Identifier: Apache-2.0
// A ray in the frame behind a portal, in pairs of floats, off by at most as much as doubles are by
// rebase_doubles.glsl. The bound is derived in docs/design/numerics.md, "Pairs of floats".

// How far from a frame, in its own lengths, a ray may begin; what is farther is not decidable.
const float OVC_MAX_PAIR_SIZES = 4096.0;

uvec2 double_at(uvec4 texel, int i) { return i == 0 ? texel.xy : texel.zw; }

// The points org + t dir, t_min <= t <= t_max, in the world. t counts in lengths of dir, whose
// largest component has a magnitude in [1, 2).
struct WorldRay {
    uvec2 org[3]; // doubles
    FloatPair dir[3];
    FloatPair t_min;
    FloatPair t_max;
    bool in_range; // for the exponents of pairs
};

WorldRay world_ray(int ray) {
    uvec4 texels[4];
    for (int i = 0; i < 4; ++i)
        texels[i] = ray_texel(ray * OVC_RAY_TEXELS + i);
    WorldRay world;
    uvec2 dir[3];
    int exponent = 0;
    for (int axis = 0; axis < 3; ++axis) {
        world.org[axis] = double_at(texels[axis / 2], axis % 2);
        dir[axis] = double_at(texels[2 + axis / 2], axis % 2);
        exponent = max(exponent, int(dir[axis].y >> 20) & 0x7ff);
    }
    exponent -= 1023;
    for (int axis = 0; axis < 3; ++axis)
        world.dir[axis] = pair_of(dir[axis], -exponent);
    world.t_min = pair_of(double_at(texels[1], 1), exponent);
    world.t_max = pair_of(double_at(texels[3], 1), exponent);
    world.in_range = abs(exponent) <= 900;
    return world;
}

// The map from the world to the frame behind a portal, and the part that lies there (layout.h).
struct Portal {
    uvec2 origin[3]; // doubles, in the world; 0 in the frame
    FloatPair rows[9];
    vec3 lo; // the box of what lies behind it, in the frame
    vec3 hi;
    int tree; // the unit of its header
    uint first_number;
};

Portal portal_at(int number) {
    int texel = number * OVC_PORTAL_TEXELS;
    uvec2 d[12];
    for (int i = 0; i < 6; ++i) {
        d[2 * i] = portal_texel(texel + i).xy;
        d[2 * i + 1] = portal_texel(texel + i).zw;
    }
    Portal portal;
    for (int axis = 0; axis < 3; ++axis)
        portal.origin[axis] = d[axis];
    for (int i = 0; i < 9; ++i)
        portal.rows[i] = pair_of(d[3 + i], 0);
    uvec4 g = portal_texel(texel + 6), h = portal_texel(texel + 7);
    portal.lo = uintBitsToFloat(g.xyz);
    portal.hi = uintBitsToFloat(uvec3(g.w, h.x, h.y));
    portal.tree = int(h.z);
    portal.first_number = h.w;
    return portal;
}

// Returns the product of a row with v; sizes: the same with all terms by their magnitudes.
FloatPair row_product(Portal portal, int row, FloatPair v[3], out float sizes) {
    FloatPair terms[3];
    sizes = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        terms[axis] = product(portal.rows[3 * row + axis], v[axis]);
        sizes += abs(terms[axis].hi);
    }
    return sum(sum(terms[0], terms[1]), terms[2]);
}

// A ray in a frame. reach, dir_reach: as in rebase_doubles.glsl.
struct FrameRay {
    FloatPair org[3];
    FloatPair dir[3];
    float reach;
    float dir_reach;
    bool in_range;
};

FrameRay frame_ray(WorldRay ray, Portal portal) {
    FloatPair from_origin[3];
    float farthest = 0.0, stretch = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        from_origin[axis] = difference(ray.org[axis], portal.origin[axis]);
        farthest = max(farthest, abs(from_origin[axis].hi));
    }
    for (int i = 0; i < 9; ++i)
        stretch = max(stretch, abs(portal.rows[i].hi));
    FrameRay frame;
    frame.reach = 0.0;
    frame.dir_reach = 0.0;
    for (int row = 0; row < 3; ++row) {
        float sizes;
        frame.org[row] = row_product(portal, row, from_origin, sizes);
        frame.reach = max(frame.reach, sizes);
        frame.dir[row] = row_product(portal, row, ray.dir, sizes);
        frame.dir_reach = max(frame.dir_reach, sizes);
    }
    // Far from where floats overflow, or lose bits below their least exponent.
    frame.in_range = ray.in_range && farthest <= 1.0e18 && stretch >= 1.0e-9 && stretch <= 1.0e9 &&
                     frame.dir_reach >= 1.0e-6 * stretch;
    return frame;
}

// Where a ray is inside a box: from a t before it enters until a t after it leaves. It enters at
// `enters` at the latest.
struct Inside {
    float enter;
    float enters;
    float exit;
    bool outside;
};

// Floats tell a t to 10 u of the lengths that it comes from, and to what the direction is off by.
Inside inside_box(FrameRay frame, vec3 lo, vec3 hi) {
    const float slack = 5.9604644775390625e-7; // 10 u
    Inside inside = Inside(-OVC_MAX_PART, -OVC_MAX_PART, OVC_MAX_PART, false);
    for (int axis = 0; axis < 3; ++axis) {
        float org = frame.org[axis].hi, dir = frame.dir[axis].hi;
        float off = slack * (abs(org) + 1.0);
        bool still = abs(dir) <= 9.094947017729282e-13 * frame.dir_reach; // 2^-40
        bool beside = org < lo[axis] - off || org > hi[axis] + off;
        float inv_dir = 1.0 / (still ? 1.0 : dir);
        float share = slack + 1.1368683772161603e-13 * frame.dir_reach * abs(inv_dir); // 2^-43
        float a = (lo[axis] - org) * inv_dir, b = (hi[axis] - org) * inv_dir;
        float first = min(a, b), last = max(a, b);
        float first_off = abs(first) * share + off * abs(inv_dir);
        float last_off = abs(last) * share + off * abs(inv_dir);
        inside.outside = inside.outside || (still && beside);
        inside.enter = still ? inside.enter : max(inside.enter, first - first_off);
        inside.enters = still ? inside.enters : max(inside.enters, first + first_off);
        inside.exit = still ? inside.exit : min(inside.exit, last + last_off);
    }
    return inside;
}

LocalRay local_ray(WorldRay ray, Portal portal) {
    FrameRay frame = frame_ray(ray, portal);
    Inside inside = inside_box(frame, portal.lo, portal.hi);
    FloatPair enter = ray.t_min, exit = ray.t_max;
    if (inside.enter > enter.hi)
        enter = FloatPair(inside.enter, 0.0);
    if (inside.exit < exit.hi)
        exit = FloatPair(inside.exit, 0.0);
    FloatPair stretch = difference(exit, enter);
    int longest = abs(frame.dir[1].hi) > abs(frame.dir[0].hi) ? 1 : 0;
    longest = abs(frame.dir[2].hi) > abs(frame.dir[longest].hi) ? 2 : longest;
    FloatPair speed = frame.dir[longest];
    if (speed.hi < 0.0)
        speed = negated(speed);
    LocalRay local;
    local.times = Times(enter, speed);
    for (int axis = 0; axis < 3; ++axis) {
        FloatPair dir = frame.dir[axis];
        local.org[axis] = sum(frame.org[axis], product(dir, enter)).hi;
        local.dir[axis] = axis == longest ? (dir.hi < 0.0 ? -1.0 : 1.0) : quotient(dir, speed).hi;
    }
    FloatPair length = product(stretch, speed);
    // Rounded up, past what pairs may have lost.
    local.t_end = uintBitsToFloat(floatBitsToUint(length.hi) + 2u);
    local.early = max(inside.enters - enter.hi, 0.0) * speed.hi * 1.0001;
    // Written so that a NaN is not decidable either.
    float reach = max(frame.reach, frame.dir_reach * abs(enter.hi));
    local.decidable = frame.in_range && reach <= OVC_MAX_PAIR_SIZES &&
                      frame.dir_reach <= OVC_MAX_PAIR_SIZES * speed.hi;
    bool is_ray = difference(ray.t_max, ray.t_min).hi >= 0.0;
    local.meets = is_ray && (!local.decidable || (!inside.outside && stretch.hi >= 0.0));
    return local;
}
