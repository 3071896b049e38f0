// SPDX-License-Identifier: Apache-2.0
// Level 1 in the kernel: where a ray goes next, and the ray in a leaf's frame. In double, the twin of kdtree/restart.cpp.
// Based on: Foley and Sugerman 2005, section 3.1 (kd-restart); thesis, section 3.4 (algorithm 4).

#if OVC_BUFFER_IMAGES
layout(rgba32ui, binding = OVC_BINDING_LEVEL1) uniform readonly restrict uimageBuffer level1;
uvec4 level1_texel(int i) { return imageLoad(level1, i); }
#else
layout(binding = OVC_BINDING_LEVEL1) uniform usamplerBuffer level1;
uvec4 level1_texel(int i) { return texelFetch(level1, i); }
#endif

double double_of(uvec2 words) { return packDouble2x32(words); }
dvec2 doubles(int texel) {
    uvec4 words = level1_texel(texel);
    return dvec2(double_of(words.xy), double_of(words.zw));
}

const double OVC_FAR = 1.0e308; // stands for infinity, which not every driver's doubles have

// The points org + t dir, t_min <= t <= t_max.
struct WorldRay {
    dvec3 org;
    dvec3 dir;
    dvec3 inv_dir;
    double t_min;
    double t_max;
};

// Where a coordinate of the ray passes `plane`: beyond all t where it never moves.
double crossing(double plane, double org, double dir, double inv_dir) {
    precise double t = (plane - org) * inv_dir;
    return dir == 0.0 ? (org <= plane ? OVC_FAR : -OVC_FAR) : t;
}

// The part of the ray inside the box of six doubles at `texel`; empty where x > y.
dvec2 inside_box(WorldRay ray, int texel) {
    dvec2 a = doubles(texel);
    dvec2 b = doubles(texel + 1);
    dvec2 c = doubles(texel + 2);
    dvec3 lo = dvec3(a, b.x);
    dvec3 hi = dvec3(b.y, c);
    precise dvec3 t_lo = (lo - ray.org) * ray.inv_dir;
    precise dvec3 t_hi = (hi - ray.org) * ray.inv_dir;
    dvec2 inside = dvec2(ray.t_min, ray.t_max);
    for (int axis = 0; axis < 3; ++axis) {
        bool still = ray.dir[axis] == 0.0;
        bool outside = still && (ray.org[axis] < lo[axis] || ray.org[axis] > hi[axis]);
        double enter = still ? inside.x : min(t_lo[axis], t_hi[axis]);
        double exit = still ? inside.y : max(t_lo[axis], t_hi[axis]);
        inside = outside ? dvec2(1.0, 0.0) : dvec2(max(inside.x, enter), min(inside.y, exit));
    }
    return inside;
}

// A leaf node of level 1: its leaves, and where the ray leaves its cell.
struct Cell {
    int first;
    int end;
    double exit;
};

// The cell that holds the ray just after t. Planes are met at times computed in one way only, so that a restart at the exit
// of a cell always lands in the next: t grows with every cell, and none comes twice.
Cell cell_after(WorldRay ray, double t) {
    Cell cell = Cell(0, 0, ray.t_max);
    int node = int(level1_texel(OVC_LEVEL1_START).x);
    for (;;) {
        uvec4 words = level1_texel(node);
        int axis = int(words.z & 3u);
        if (axis == 3) {
            cell.first = int(words.w);
            cell.end = cell.first + int(words.z >> 2);
            break;
        }
        double dir = axis == 0 ? ray.dir.x : (axis == 1 ? ray.dir.y : ray.dir.z);
        double org = axis == 0 ? ray.org.x : (axis == 1 ? ray.org.y : ray.org.z);
        double inv_dir = axis == 0 ? ray.inv_dir.x : (axis == 1 ? ray.inv_dir.y : ray.inv_dir.z);
        double plane = crossing(double_of(words.xy), org, dir, inv_dir);
        bool before = t < plane;
        cell.exit = before ? min(cell.exit, plane) : cell.exit;
        node = before == (dir >= 0.0) ? node + 1 : int(words.w);
    }
    return cell;
}

// A ray in a leaf's frame (docs/numerics.md), and how to come back: world t = enter + t / speed.
struct LocalRay {
    vec3 org;
    float t_end;
    double enter;
    double speed;
    bool decidable; // false: double cannot say where it enters to within 1/64 of a float rounding
};

// Rounded to nearest, whatever the driver's conversion does.
float nearest_float(double d) {
    precise float rounded = float(d);
    precise float rest = float(d - double(rounded));
    precise float result = rounded + rest;
    return result;
}
vec3 nearest_floats(dvec3 d) { return vec3(nearest_float(d.x), nearest_float(d.y), nearest_float(d.z)); }

// The length in which local rays count t: of the direction's longest component, which becomes 1 or -1.
double longest_component(WorldRay ray) {
    dvec3 size = abs(ray.dir);
    return max(size.x, max(size.y, size.z));
}

vec3 local_direction(WorldRay ray, double longest) {
    precise dvec3 dir = ray.dir / longest;
    // Exactly 1 or -1, which the basis builds on and a driver's division need not give.
    vec3 signs = mix(vec3(1.0), vec3(-1.0), lessThan(ray.dir, dvec3(0.0)));
    return mix(nearest_floats(dir), signs, equal(abs(ray.dir), dvec3(longest)));
}

LocalRay rebase(WorldRay ray, double longest, int leaf_texel, dvec2 inside) {
    dvec2 a = doubles(leaf_texel + 3);
    dvec2 b = doubles(leaf_texel + 4);
    double scale = b.y;
    precise dvec3 from_origin = ray.org - dvec3(a, b.x);
    precise dvec3 travelled = ray.dir * inside.x;
    precise dvec3 org = (from_origin + travelled) * scale;
    LocalRay local;
    local.org = nearest_floats(org);
    local.enter = inside.x;
    local.speed = longest * scale;
    double length = (inside.y - inside.x) * local.speed;
    local.t_end = uintBitsToFloat(floatBitsToUint(float(length)) + 2u); // up, past what the conversion may have lost
    dvec3 reach = max(abs(from_origin), abs(travelled)) * scale;
    // Written so that a NaN is not decidable either.
    local.decidable = max(reach.x, max(reach.y, reach.z)) <= double(OVC_MOST_LEAF_SIZES) && length <= 1.0e30 &&
                      local.speed >= 1.0e-300 && local.speed <= 1.0e300;
    return local;
}
