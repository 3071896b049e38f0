// SPDX-License-Identifier: Apache-2.0
// A ray against the four boxes of a node. Boxes are padded when packed, by more than anything here can round.
// Based on: Ize 2013, "Robust BVH Ray Traversal"; Ylitie et al. 2017 (quantised boxes folded into the ray).

// The ray in grid coordinates: a plane at grid coordinate g is met at t = g * scale + offset.
struct GridRay {
    vec3 scale;
    vec3 offset;
    bvec3 backward; // the direction is negative: hi is the near plane
};

// A component below 1e-18 moves the ray by less than any padding over the whole leaf; its reciprocal stays finite.
vec3 finite_reciprocal(vec3 dir) {
    vec3 tiny = mix(vec3(1e-18), vec3(-1e-18), lessThan(dir, vec3(0.0)));
    return 1.0 / mix(dir, tiny, lessThan(abs(dir), vec3(1e-18)));
}

GridRay grid_ray(vec3 org, vec3 inv_dir, vec3 grid_org, vec3 grid_cell) {
    return GridRay(grid_cell * inv_dir, (grid_org - org) * inv_dir, lessThan(inv_dir, vec3(0.0)));
}

// Four 16-bit coordinates of one side, two to a word.
vec4 coordinates(uvec2 words) {
    return vec4(ivec4(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu, words.y >> 16));
}

// A node's four boxes, per axis their planes in grid coordinates: lo and hi; for one ray alone the near and the far ones, which
// are selected by the word, before they are decoded.
struct Boxes {
    vec4 lo[3];
    vec4 hi[3];
};

Boxes boxes_of(uvec4 x, uvec4 y, uvec4 z, bvec3 backward) {
#if OVC_PACKET == 1
    x = backward.x ? x.zwxy : x;
    y = backward.y ? y.zwxy : y;
    z = backward.z ? z.zwxy : z;
#endif
    return Boxes(vec4[3](coordinates(x.xy), coordinates(y.xy), coordinates(z.xy)),
                 vec4[3](coordinates(x.zw), coordinates(y.zw), coordinates(z.zw)));
}

ivec4 when(vec4 planes, float scale, float offset) { return floatBitsToInt(planes * scale + offset); }

const int OVC_NO_CHILD = 0x7fffffff;

// Sort keys of the four children: the bits of the entry t with the child's number in the two lowest, OVC_NO_CHILD where
// the ray misses. Non-negative floats order as their bits do, and signed integer min and max are one instruction where
// float ones are three; a negative entry loses against 0, a negative exit fails the comparison as it should.
ivec4 child_keys(Boxes boxes, GridRay ray, float t_end) {
    ivec4 enter = ivec4(0);
    ivec4 exit = ivec4(floatBitsToInt(t_end));
    for (int i = 0; i < 3; ++i) {
        ivec4 a = when(boxes.lo[i], ray.scale[i], ray.offset[i]);
        ivec4 b = when(boxes.hi[i], ray.scale[i], ray.offset[i]);
        enter = max(enter, OVC_PACKET == 1 ? a : min(a, b));
        exit = min(exit, OVC_PACKET == 1 ? b : max(a, b));
    }
    return mix(ivec4(OVC_NO_CHILD), (enter & ~3) | ivec4(0, 1, 2, 3), lessThanEqual(enter, exit));
}

// A missing child is a box with hi below lo, which one ray's keys leave out by themselves.
ivec4 keys_of_present(ivec4 keys, Boxes boxes) {
    return OVC_PACKET == 1 ? keys : mix(ivec4(OVC_NO_CHILD), keys, lessThanEqual(boxes.lo[0], boxes.hi[0]));
}

void order(inout int a, inout int b) {
    int low = min(a, b);
    b = max(a, b);
    a = low;
}

// Nearest first: a sorting network of five comparisons.
void sort_keys(inout ivec4 k) {
    order(k.x, k.y);
    order(k.z, k.w);
    order(k.x, k.z);
    order(k.y, k.w);
    order(k.y, k.z);
}
