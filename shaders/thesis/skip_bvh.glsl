// SPDX-License-Identifier: Apache-2.0
// Walks a BVH without a stack, some steps at a time: nodes and triangles lie depth first, and a
// node names the place where a ray that misses it goes on. Layout: plugin/thesis/skip_bvh.h.
// Based on: thesis, section 3.1; Thrane and Simonsen 2005, section 4.4.

// Where a ray stands: the texel of the next node or triangle, and its findings so far.
struct Walk {
    int at;
    Found found;
};

// Returns whether the ray meets the box at some t in [0, t_end]. Boxes are padded by more than the
// roundings here.
bool meets(vec3 lo, vec3 hi, vec3 org, vec3 inv_dir, float t_end) {
    vec3 a = (lo - org) * inv_dir;
    vec3 b = (hi - org) * inv_dir;
    vec3 enter = min(a, b);
    vec3 exit = max(a, b);
    return max(max(enter.x, enter.y), max(enter.z, 0.0)) <= min(min(exit.x, exit.y), min(exit.z, t_end));
}

// Walks through at most `steps` nodes and triangles, or to `end`.
void go_on(inout Walk walk, int end, int steps, vec3 org, vec3 dir, uint skip) {
    Line line = line_of(org, dir);
    vec3 inv_dir = finite_reciprocal(dir);
    for (int step = 0; step < steps && walk.at < end; ++step) {
        uvec4 A = scene_texel(walk.at);
        uvec4 B = scene_texel(walk.at + 1);
        uvec4 C = scene_texel(walk.at + 2);
        bool is_triangle = int(A.w) < 0;
        bool inside =
            meets(uintBitsToFloat(A.xyz), uintBitsToFloat(B.xyz), org, inv_dir, walk.found.best_hi);
        bool took = take_triangle(walk.found, A, B, C, is_triangle, line, skip);
        walk.at = is_triangle ? walk.at + 3 : (inside ? walk.at + 2 : int(A.w));
        walk.at = OVC_ANY_HIT != 0 && took ? end : walk.at;
    }
}
