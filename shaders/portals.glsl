// SPDX-License-Identifier: Apache-2.0
// Portals: where a ray comes to a part in another frame. The kernel computes the ray there in
// doubles, from the ray in the world (docs/design/numerics.md, "Frames").

#if OVC_PORTALS
OVC_TEXELS(OVC_BINDING_PORTALS, PortalTexels) portals;
uvec4 portal_texel(int i) { return OVC_TEXEL(portals, i); }

dvec2 doubles_of(uvec4 words) { return dvec2(packDouble2x32(words.xy), packDouble2x32(words.zw)); }

// The points org + t dir, t_min <= t <= t_max, in the world.
struct WorldRay {
    dvec3 org;
    dvec3 dir;
    double t_min;
    double t_max;
};

WorldRay world_ray(int ray) {
    int texel = ray * OVC_RAY_TEXELS;
    dvec2 a = doubles_of(ray_texel(texel)), b = doubles_of(ray_texel(texel + 1));
    dvec2 c = doubles_of(ray_texel(texel + 2)), d = doubles_of(ray_texel(texel + 3));
    return WorldRay(dvec3(a, b.x), dvec3(c, d.x), b.y, d.y);
}

// The map from the world to the frame behind a portal, and the part that lies there (layout.h).
struct Portal {
    dvec3 origin; // in the world; 0 in the frame
    dvec3 rows[3];
    dvec3 lo; // the box of what lies behind it, in the frame
    dvec3 hi;
    int tree; // the unit of its header
    uint first_number;
    ivec2 far; // the texel and the number of its far triangles
};

Portal portal_at(int number) {
    int texel = number * OVC_PORTAL_TEXELS;
    dvec2 d[9];
    for (int i = 0; i < 9; ++i)
        d[i] = doubles_of(portal_texel(texel + i));
    uvec4 last = portal_texel(texel + 9);
    return Portal(dvec3(d[0], d[1].x), dvec3[3](dvec3(d[1].y, d[2]), dvec3(d[3], d[4].x), dvec3(d[4].y, d[5])),
                  dvec3(d[6], d[7].x), dvec3(d[7].y, d[8]), int(last.x), last.y, ivec2(last.zw));
}

dvec3 times(dvec3 rows[3], dvec3 v) {
    precise dvec3 result = dvec3(rows[0].x * v.x + rows[0].y * v.y + rows[0].z * v.z,
                                 rows[1].x * v.x + rows[1].y * v.y + rows[1].z * v.z,
                                 rows[2].x * v.x + rows[2].y * v.y + rows[2].z * v.z);
    return result;
}
double largest(dvec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// Returns the t's of org + t dir, t_min <= t <= t_max, inside the box; none if x > y.
dvec2 inside_box(dvec3 org, dvec3 dir, dvec3 lo, dvec3 hi, double t_min, double t_max) {
    dvec2 inside = dvec2(t_min, t_max);
    bool outside = false;
    for (int axis = 0; axis < 3; ++axis) {
        bool still = dir[axis] == 0.0;
        double inv_dir = 1.0 / (still ? 1.0 : dir[axis]);
        precise double a = (lo[axis] - org[axis]) * inv_dir, b = (hi[axis] - org[axis]) * inv_dir;
        outside = outside || (still && (org[axis] < lo[axis] || org[axis] > hi[axis]));
        inside = still ? inside : dvec2(max(inside.x, min(a, b)), min(inside.y, max(a, b)));
    }
    return outside ? dvec2(1.0, 0.0) : inside;
}

// Returns d rounded to nearest, whatever the driver's conversion does.
float nearest_float(double d) {
    precise float rounded = float(d);
    precise float rest = float(d - double(rounded));
    precise float result = rounded + rest;
    return result;
}
vec3 nearest_floats(dvec3 d) { return vec3(nearest_float(d.x), nearest_float(d.y), nearest_float(d.z)); }

// A ray in a frame, in doubles. reach, dir_reach: the largest component of org and of dir if all
// terms are taken by their magnitudes; roundings are in proportion to them.
struct FrameRay {
    dvec3 org;
    dvec3 dir;
    double reach;
    double dir_reach;
};

FrameRay frame_ray(WorldRay ray, Portal portal) {
    precise dvec3 from_origin = ray.org - portal.origin;
    dvec3 sizes[3] = dvec3[3](abs(portal.rows[0]), abs(portal.rows[1]), abs(portal.rows[2]));
    return FrameRay(times(portal.rows, from_origin), times(portal.rows, ray.dir),
                    largest(times(sizes, abs(from_origin))), largest(times(sizes, abs(ray.dir))));
}

// A ray in a frame, as the traversal takes it, and the times that lead back to the world's t.
struct LocalRay {
    vec3 org; // where it enters the box
    vec3 dir; // the largest component 1 or -1
    float t_end;
    bool meets;     // the box
    bool decidable; // doubles can say where it enters
    Times times;
};

LocalRay local_ray(WorldRay ray, Portal portal) {
    FrameRay frame = frame_ray(ray, portal);
    dvec3 org = frame.org, dir = frame.dir;
    dvec2 inside = inside_box(org, dir, portal.lo, portal.hi, ray.t_min, ray.t_max);
    double speed = largest(dir);
    LocalRay local;
    local.meets = inside.x <= inside.y && ray.t_min <= ray.t_max;
    local.times = Times(inside.x, speed);
    precise dvec3 at = org + dir * inside.x;
    local.org = nearest_floats(at);
    precise dvec3 unit = dir / speed;
    // The largest component is exactly 1 or -1: the basis relies on that, and a driver's division
    // need not give it.
    vec3 signs = mix(vec3(1.0), vec3(-1.0), lessThan(dir, dvec3(0.0)));
    local.dir = mix(nearest_floats(unit), signs, equal(abs(dir), dvec3(speed)));
    double length = (inside.y - inside.x) * speed;
    // Rounded up, past the amount that the conversion may have lost.
    local.t_end = uintBitsToFloat(floatBitsToUint(float(length)) + 2u);
    double reach = max(frame.reach, frame.dir_reach * abs(inside.x));
    // Written so that a NaN is not decidable either.
    local.decidable = reach <= double(OVC_MAX_LEAF_SIZES) && length <= 1.0e30 &&
                      speed >= 1.0e-300 && speed <= 1.0e300;
    return local;
}

// Pushes a word that leads to unit 0. It lies below the words of the part that the ray comes to.
void push_mark(inout Descent d) {
    bool store = !is_none(d.top);
#if OVC_STACK_REGISTERS
    d.lost = d.lost || (store && !is_none(d.stack[OVC_STACK_DEPTH - 1]));
    Word above = d.top;
    for (int i = 0; i < OVC_STACK_DEPTH; ++i) {
        Word own = d.stack[i];
        d.stack[i] = store ? above : own;
        above = own;
    }
#else
    d.lost = d.lost || (store && d.height >= OVC_STACK_DEPTH - 1);
    if (store && !d.lost) {
        ++d.height;
        d.stack[d.height] = d.top;
    }
#endif
    d.top = word_of(0, 4);
}

void set_local_ray(inout Packet packet, LocalRay local, Tree tree) {
    packet.backward = lessThan(local.dir, vec3(0.0));
    packet.axes = axes_of(local.dir);
    set_ray(packet, 0, tree, local.org, direction_of(local.dir, packet.axes), packet.skip[0],
            packet.any_hit[0]);
}

// Returns the ray in the frame of the top-level tree, whose portal is the first.
LocalRay scene_ray(int ray) { return local_ray(world_ray(ray), portal_at(0)); }

#if OVC_FAR_TRIANGLES
#include "far.glsl"
#endif

// Takes a ray that has come to a portal behind it. Returns false if there is no portal, or if the
// ray goes no farther.
bool enter_portal(int ray, inout Descent d, inout Packet packet, inout Found found) {
    if (d.unit >= 0 || d.lost || found.best_hi < 0.0)
        return false;
    Portal portal = portal_at(-d.unit);
#if OVC_FAR_TRIANGLES
    if (portal.far.y > 0) {
        take_far_triangles(world_ray(ray), portal, packet, found);
        d.unit = 0;
        d.done = found.best_hi < 0.0;
        return !d.done;
    }
#endif
    LocalRay local = local_ray(world_ray(ray), portal);
    Found there = in_times(found, packet.place.part, local.times, local.t_end);
    bool decidable = local.decidable && there.best_hi != OVC_UNDECIDABLE;
    d.unit = 0; // if the part has nothing for the ray, it goes on to the next of the stack
    if (local.meets && !decidable) {
        found.best_hi = OVC_UNDECIDABLE;
    } else if (local.meets && there.best_hi >= 0.0) { // else its hit comes before the part
        Tree tree = tree_of(portal.tree, 0);
        found = there;
        packet.place.part = local.times;
        packet.place.behind_portal = true;
        packet.first_number = portal.first_number;
        measure(packet.place);
        set_local_ray(packet, local, tree);
        push_mark(d);
        d.unit = tree.start.x;
    }
    d.done = d.lost || found.best_hi < 0.0;
    return !d.done;
}
#endif
