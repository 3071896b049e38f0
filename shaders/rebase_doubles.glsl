// SPDX-License-Identifier: Apache-2.0
// A ray in the frame behind a portal, in doubles.

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
};

Portal portal_at(int number) {
    int texel = number * OVC_PORTAL_TEXELS;
    dvec2 d[9];
    for (int i = 0; i < 9; ++i)
        d[i] = doubles_of(portal_texel(texel + i));
    uvec4 last = portal_texel(texel + 9);
    return Portal(dvec3(d[0], d[1].x), dvec3[3](dvec3(d[1].y, d[2]), dvec3(d[3], d[4].x), dvec3(d[4].y, d[5])),
                  dvec3(d[6], d[7].x), dvec3(d[7].y, d[8]), int(last.x), last.y);
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

LocalRay local_ray(WorldRay ray, Portal portal) {
    FrameRay frame = frame_ray(ray, portal);
    dvec3 org = frame.org, dir = frame.dir;
    dvec2 inside = inside_box(org, dir, portal.lo, portal.hi, ray.t_min, ray.t_max);
    double speed = largest(dir);
    LocalRay local;
    local.meets = inside.x <= inside.y && ray.t_min <= ray.t_max;
    local.times = Times(inside.x, speed);
    local.early = 0.0;
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
    local.decidable = reach <= double(OVC_MAX_LEAF_SIZES) && length <= 1.0e30lf &&
                      speed >= 1.0e-300lf && speed <= 1.0e300lf;
    return local;
}
