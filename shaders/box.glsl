// SPDX-License-Identifier: Apache-2.0
// Tests a ray against the four boxes of a node. The packer pads boxes by more than the roundings
// here.
// Based on: Ize 2013, "Robust BVH Ray Traversal"; Ylitie et al. 2017 (quantised boxes folded into
// the ray).

#if OVC_MAY_WAIT
#define OVC_EXACTLY precise // so that the key of a link has the same bits in every kernel
#else
#define OVC_EXACTLY
#endif

// The ray in grid coordinates: it meets a plane at g, in 65,536ths of a cell from the grid's
// middle, at t = g * scale + offset.
struct GridRay {
    vec3 scale;
    vec3 offset;
};

// A component below 1e-18 moves the ray by less than any padding over the whole leaf. Replacing it
// keeps the reciprocal finite.
vec3 finite_reciprocal(vec3 dir) {
    vec3 tiny = mix(vec3(1e-18), vec3(-1e-18), lessThan(dir, vec3(0.0)));
    OVC_EXACTLY vec3 inv_dir = 1.0 / mix(dir, tiny, lessThan(abs(dir), vec3(1e-18)));
    return inv_dir;
}

GridRay grid_ray(vec3 org, vec3 inv_dir, vec3 grid_middle, vec3 grid_cell) {
    OVC_EXACTLY vec3 scale = grid_cell * inv_dir * (1.0 / 65536.0);
    OVC_EXACTLY vec3 offset = (grid_middle - org) * inv_dir;
    return GridRay(scale, offset);
}

// Four 16-bit coordinates of one side, two to a word. The upper one keeps the lower one as its
// fraction, which the packer allows for.
vec4 coordinates(uvec2 words) {
    return vec4(ivec4(words.x << 16, words.x, words.y << 16, words.y));
}

// A node's four boxes: per axis, their near and far planes in grid coordinates. boxes_of() selects
// whole words before it decodes them. backward: the direction is negative, so hi is the near plane.
struct Boxes {
    vec4 near[3];
    vec4 far[3];
};

Boxes boxes_of(uvec4 x, uvec4 y, uvec4 z, bvec3 backward) {
    x = backward.x ? x.zwxy : x;
    y = backward.y ? y.zwxy : y;
    z = backward.z ? z.zwxy : z;
    return Boxes(vec4[3](coordinates(x.xy), coordinates(y.xy), coordinates(z.xy)),
                 vec4[3](coordinates(x.zw), coordinates(y.zw), coordinates(z.zw)));
}

ivec4 when(vec4 planes, float scale, float offset) {
    OVC_EXACTLY vec4 t = planes * scale + offset;
    return floatBitsToInt(t);
}

const int OVC_NO_CHILD = 0x7ffffffc;
const int OVC_NO_END = 0x80000000; // the end of a ray that meets no box
// -2^-123, the end of a ray that looks for nothing any more. It is near to 0, as layout.h wants.
const float OVC_ENOUGH = -9.4039548065783e-38f;

// The t's at which the ray enters and leaves each of the four boxes before `end`, as the bits of
// floats. It meets a box if `enter` is less than `exit`. Floats that are not negative order as
// their bits do, and signed integer min and max are one instruction where float ones are three.
// Negative floats order the other way round: min and max then choose the min entry and the max
// exit, and a box that lies all behind the ray's beginning has its exit first.
struct Stretches {
    ivec4 enter;
    ivec4 exit;
};

// end: the bits of the ray's end.
Stretches stretches(Boxes boxes, GridRay ray, int end) {
    ivec4 enter = when(boxes.near[0], ray.scale[0], ray.offset[0]);
    ivec4 exit = min(ivec4(end), when(boxes.far[0], ray.scale[0], ray.offset[0]));
    for (int i = 1; i < 3; ++i) {
        enter = max(enter, when(boxes.near[i], ray.scale[i], ray.offset[i]));
        exit = min(exit, when(boxes.far[i], ray.scale[i], ray.offset[i]));
    }
    return Stretches(enter, exit);
}

// Returns where the ray enters each of the four children, OVC_NO_CHILD if it misses.
ivec4 entries(Stretches s) {
    return mix(ivec4(OVC_NO_CHILD), s.enter, lessThan(s.enter, s.exit));
}
