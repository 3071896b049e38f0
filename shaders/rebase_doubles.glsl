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
// Nothing here is an array of doubles: NVIDIA's compiler (driver 580) keeps those in memory of
// floats, where a double's low word that looks like a subnormal float becomes 0.
struct Portal {
    dvec3 origin; // in the world; 0 in the frame
    dvec3 row_x;
    dvec3 row_y;
    dvec3 row_z;
    vec3 lo; // the box of what lies behind it, in the frame
    vec3 hi;
    int tree; // the unit of its header
    uint first_number;
};

Portal portal_at(int number) {
    int texel = number * OVC_PORTAL_TEXELS;
    dvec2 a = doubles_of(portal_texel(texel)), b = doubles_of(portal_texel(texel + 1));
    dvec2 c = doubles_of(portal_texel(texel + 2)), d = doubles_of(portal_texel(texel + 3));
    dvec2 e = doubles_of(portal_texel(texel + 4)), f = doubles_of(portal_texel(texel + 5));
    uvec4 g = portal_texel(texel + 6), h = portal_texel(texel + 7);
    return Portal(dvec3(a, b.x), dvec3(b.y, c), dvec3(d, e.x), dvec3(e.y, f),
                  uintBitsToFloat(g.xyz), uintBitsToFloat(uvec3(g.w, h.x, h.y)), int(h.z), h.w);
}

double product(dvec3 row, dvec3 v) {
    precise double result = row.x * v.x + row.y * v.y + row.z * v.z;
    return result;
}
dvec3 to_frame(Portal portal, dvec3 v) {
    return dvec3(product(portal.row_x, v), product(portal.row_y, v), product(portal.row_z, v));
}
double largest(dvec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }
// Returns the largest component of to_frame(portal, v) if all terms are taken by their magnitudes.
double largest_terms(Portal portal, dvec3 v) {
    dvec3 size = abs(v);
    return largest(dvec3(product(abs(portal.row_x), size), product(abs(portal.row_y), size),
                         product(abs(portal.row_z), size)));
}

// Returns d rounded to nearest, whatever the driver's conversion does.
float nearest_float(double d) {
    precise float rounded = float(d);
    precise float rest = float(d - double(rounded));
    precise float result = rounded + rest;
    return result;
}
vec3 nearest_floats(dvec3 d) { return vec3(nearest_float(d.x), nearest_float(d.y), nearest_float(d.z)); }

// A ray in a frame, in doubles. reach, dir_reach: largest_terms() of org and of dir; roundings are
// in proportion to them.
struct FrameRay {
    dvec3 org;
    dvec3 dir;
    double reach;
    double dir_reach;
};

FrameRay frame_ray(WorldRay ray, Portal portal) {
    precise dvec3 from_origin = ray.org - portal.origin;
    return FrameRay(to_frame(portal, from_origin), to_frame(portal, ray.dir),
                    largest_terms(portal, from_origin), largest_terms(portal, ray.dir));
}

// Returns the t's in `inside` at which org + t dir lies between lo and hi; none if x > y.
dvec2 between(dvec2 inside, double org, double dir, double lo, double hi) {
    bool still = dir == 0.0;
    precise double inv_dir = 1.0 / (still ? 1.0 : dir);
    precise double a = (lo - org) * inv_dir, b = (hi - org) * inv_dir;
    bool outside = still && (org < lo || org > hi);
    dvec2 crossed = dvec2(max(inside.x, min(a, b)), min(inside.y, max(a, b)));
    return outside ? dvec2(1.0, 0.0) : (still ? inside : crossed);
}

// Returns how far the ray may be off, in doubles, from where it comes to the box: from farther away
// it may seem to miss it. The box lies within 2 of the origin.
double off_at_box(FrameRay ray, double speed) {
    const double rounding = 1.7763568394002505e-15lf; // 2^-49
    precise double ratio = ray.dir_reach / max(speed, 1.0e-300lf);
    precise double off = min((ray.reach + (ray.reach + 2.0) * ratio) * rounding, 1.0e290lf);
    return off;
}

dvec2 inside_box(FrameRay ray, Portal portal, double off, dvec2 inside) {
    precise dvec3 lo = dvec3(portal.lo) - off, hi = dvec3(portal.hi) + off;
    inside = between(inside, ray.org.x, ray.dir.x, lo.x, hi.x);
    inside = between(inside, ray.org.y, ray.dir.y, lo.y, hi.y);
    return between(inside, ray.org.z, ray.dir.z, lo.z, hi.z);
}

LocalRay local_ray(WorldRay ray, Portal portal) {
    FrameRay frame = frame_ray(ray, portal);
    dvec3 org = frame.org, dir = frame.dir;
    double speed = largest(dir);
    dvec2 inside =
        inside_box(frame, portal, off_at_box(frame, speed), dvec2(ray.t_min, ray.t_max));
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
