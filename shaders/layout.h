// SPDX-License-Identifier: Apache-2.0
// What C++ and GLSL agree on: the layout of pages, rays and answers, and the constants of the error bound.
// Included by both: preprocessor lines and comments only.
#ifndef OVC_LAYOUT_H
#define OVC_LAYOUT_H

// A page is an array of units of 4 RGBA32UI texels (64 bytes): a header, then inner nodes and triangle pairs.
//
// header  texel 0: grid origin xyz (float bits), 0
//         texel 1: grid cell xyz (float bits), 0
//         texel 2: the traversal's first state: the root's unit, the empty stack (-1), stack height 0, rounds 0
//         texel 3: 0
// node    texels 0..2: per axis, the 16-bit grid coordinates of four children's boxes: lo0|lo1<<16, lo2|lo3<<16,
//                      hi0|hi1<<16, hi2|hi3<<16. A missing child has lo = 0xffff > hi = 0.
//         texel 3: unit of the first child (children are contiguous), 0, 0, 0
// pair    texels 0..3: corners v0 v1 v2 v3 (float bits) of the triangles A = (v0, v1, v2) and B = (v0, v3, v2);
//         w of texel 0: id of A; w of texel 1: id of B or OVC_NO_TRIANGLE; w of texel 3: OVC_PAIR;
//         w of texel 2: which corner of the triangle itself the pair's v0 and v2 are, two bits each, A's then B's
#define OVC_UNIT_TEXELS 4
#define OVC_UNIT_BYTES 64
#define OVC_ROOT_UNIT 1
#define OVC_PAIR 0x80000000u
#define OVC_NO_TRIANGLE 0xffffffffu
#define OVC_MAX_UNITS 0x800000 // a stack word has 23 bits for a unit and must not be negative

// A ray is two RGBA32UI texels side by side: origin xyz, end t (float bits; negative: no ray here); direction xyz,
// scaled so that its largest component is 1 or -1 (float bits), id of the triangle it does not see or OVC_NO_TRIANGLE.
// It begins at t = 0. Coordinates are those of the leaf's frame, the origin within [-1, 1].
#define OVC_RAY_TEXELS 2

// An answer is RGBA32UI. w: the id of the certain nearest hit, OVC_MISS where there is none, OVC_FLAGGED where the kernel
// cannot tell, OVC_CAPPED where its loop was ended before it was done. x, y: up to two rivals, triangles that may be hit, and nearer than w, each OVC_NO_TRIANGLE where there is
// none; what is named neither in w nor here is certainly not the answer. In fast precision x, y, z are t, u, v (float bits).
#define OVC_MISS 0xffffffffu
#define OVC_FLAGGED 0xfffffffeu
#define OVC_CAPPED 0xfffffffdu

#define OVC_BINDING_PAGE 0
#define OVC_BINDING_RAYS 1
#define OVC_BINDING_ANSWERS 2
// The systems of the thesis: where a ray stands between passes (3 textures), and the scene (from here on).
#define OVC_BINDING_STATE 3
#define OVC_BINDING_SCENE 6

// Invocations of a work group of the compute kernel; a row of rays is a multiple.
#define OVC_GROUP_SIZE 64

// The error bound, in units of u = 2^-24 (docs/numerics.md): a projected corner p is off by at most
// u (OVC_BOUND_CONSTANT + OVC_BOUND_RELATIVE (|x| + |y| + |z|)).
#define OVC_BOUND_UNIT 5.9604644775390625e-8
#define OVC_BOUND_CONSTANT 6.0
#define OVC_BOUND_RELATIVE 11.0

#endif
