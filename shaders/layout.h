// SPDX-License-Identifier: Apache-2.0
// What C++ and GLSL agree on: the layout of pages, rays and answers, and the constants of the error bound.
// Included by both: preprocessor lines and comments only.
#ifndef OVC_LAYOUT_H
#define OVC_LAYOUT_H

// A page is an array of units of 4 RGBA32UI texels (64 bytes): a header, then inner nodes and triangle pairs.
//
// header  texel 0: the grid's middle xyz (float bits), 0
//         texel 1: grid cell xyz (float bits), 0
//         texel 2: the traversal's first state: the root's unit, -1 (the stack's height, less one), 0 (no word), 0
//         texel 3: OVC_HAS_LOOSE_PAIRS or 0, 0, 0, 0
// node    texels 0..2: per axis, the grid coordinates of four children's boxes: lo0|lo1<<16, lo2|lo3<<16,
//                      hi0|hi1<<16, hi2|hi3<<16; signed 16-bit, in cells from the grid's middle. In the kernel an upper half has the
//                      lower one as its fraction, so that lo1 and lo3 are one less than their boxes'. A missing child has the
//                      greatest lo and the least hi.
//         texel 3: unit of the first child (children are contiguous), 0, 0, 0
// pair    texels 0..3: corners v0 v1 v2 v3 (float bits) of the triangles A = (v0, v1, v2) and B = (v0, v3, v2);
//         w of texel 0: number of A; w of texel 1: that of B or OVC_NO_TRIANGLE; w of texel 3: OVC_PAIR;
//         w of texel 2: which corner of the triangle itself the pair's v0 and v2 are, two bits each, A's then B's
// loose   a pair of triangles that share no side, OVC_LOOSE_PAIR set besides: corners A0 A1 A2 B0 in the upper 24 bits of x, y, z of texels
// pair    0..3, as signed numbers of OVC_LOOSE_STEP; B1 and x of B2 each in the low bytes of x, y, z of a texel, the lowest in x's; y of B2 in
//         the upper 24 bits of w of texel 2, z of B2 in its low byte (the highest of three) and the low 16 bits of w of texel 3. A and B as above;
//         corners are in the triangle's own order.
#define OVC_UNIT_TEXELS 4
#define OVC_UNIT_BYTES 64
#define OVC_ROOT_UNIT 1
#define OVC_PAIR 0x80000000u
#define OVC_LOOSE_PAIR 0x40000000u
#define OVC_LOOSE_STEP 1.1920928955078125e-7 // 2^-23
#define OVC_LOOSE_TEXEL 3 // of the header
#define OVC_HAS_LOOSE_PAIRS 1u
#define OVC_OWN_ORDER 0x88u // both triangles' corners 0 and 2 are the pair's
#define OVC_NO_TRIANGLE 0xffffffffu
#define OVC_MAX_BUFFER_BITS 25 // of the number of a unit within its buffer; where there is one buffer a stack word has no more
#define OVC_MAX_PAGE_UNITS (1 << OVC_MAX_BUFFER_BITS)

// Under the top-level tree (gpu/page/top_level.h) units count from the pool's first, where the tree lies; else from the page's own. Where
// the pool is several buffers a unit's number is that within its buffer, and above it the number of the buffer (gpu/page/residency.h). The
// tree's lowest nodes are links, copies of pages' nodes; texel 3: the unit of the first child in the pool, or OVC_LEADS_NOWHERE;
// 1 + the page's leaf; the first child's unit in the page, 0. Of a ray that meets it a link has a key, by which links are in order: the
// upper half of the bits of the t in the tree's frame (float; 0 where it is less), and below it 1 + the leaf.
#define OVC_LEADS_NOWHERE 0
#define OVC_KEY_LEAF 0xffff

// Where pages lie in several frames the tree's lowest nodes are portals, each with one child, and behind it come the parts' trees, each
// with a header of its own; texel 3 of a portal: its number, negative; 0, 0, 0. The table of portals has OVC_PORTAL_TEXELS texels each;
// number 0 is the way back to the top-level tree. A double is two words, low one first.
//
// portal  texels 0 to 5: 12 doubles, the point of the world that lies at 0 in the frame, and the rows of the matrix from there
//         texels 6 to 8: 6 doubles, the box of what lies behind it, in the frame
//         texel 9: the unit of the tree's header, the number of the first triangle, 0, 0
#define OVC_PORTAL_TEXELS 10

// A ray is two RGBA32UI texels, in the frame that pages share: org xyz, t_end (float bits); dir xyz (float bits),
// the number of the triangle it does not see or OVC_SKIPS_NONE, with OVC_RAY_ANY_HIT added where any hit will do. It begins at
// t = 0. t_end: OVC_NO_RAY where there is none, OVC_UNDECIDABLE where only doubles can answer it; closer to 0 than any t of a box.
#define OVC_LOCAL_RAY_TEXELS 2
#define OVC_RAY_ANY_HIT 0x80000000u
#define OVC_SKIPS_NONE 0x7fffffffu
#define OVC_NO_RAY -1.1754943508222875e-38f // -2^-126
#define OVC_UNDECIDABLE -2.350988701644575e-38f
// Where not all pages are in the pool, a third texel has the key of the one that the ray waited for, 0 for none; 0, 0, 0. It is done with
// those that it meets before.
#define OVC_RESUMED_RAY_TEXELS 3
// Under portals it is five texels: the record of core/ray.h, org, t_min, dir, t_max (doubles; t_max < t_min: no ray here); then 0, 0,
// the number of the triangle it does not see or OVC_NO_TRIANGLE, and the key or 0, with OVC_RAY_ANY_HIT added.
#define OVC_RAY_TEXELS 5

// The answers of the fragment kernel are a texture. Rays lie in it in tiles of 4 x 4, in rows of tiles: fragments that a driver shades together are rays
// that came one after the other.
#define OVC_ROW_RAYS 64
#define OVC_TILE 4

// An answer is RGBA32UI; triangles are named by their numbers in the soup. z: the key of the link that the ray waits for, or
// OVC_NO_LEAF. w: the certain nearest hit in all pages that the ray met before that link, or
//   OVC_MISS      none
//   OVC_FLAGGED   the kernel cannot tell
//   OVC_CAPPED    a loop was ended before it was done, or the stack was full
// x, y: up to two more candidates, triangles that may be hit, and nearer than w, each OVC_NO_TRIANGLE where there is none; what is
// named neither in w nor here is certainly not the answer.
// In fast precision x: t of the hit in the tree's frame (float bits); y: u and v in 16 bits each.
#define OVC_NO_LEAF 0x7fffffffu
#define OVC_MISS 0x7fffffffu
#define OVC_FLAGGED 0x7ffffffeu
#define OVC_CAPPED 0x7ffffffdu
#define OVC_MAX_TRIANGLES 0x7ffffff0u
// The compute kernel writes its answers to a buffer in four planes, w x y z, a word a ray, as rays lie. A miss of which there is no
// more to say is not written: the host has put OVC_MISS there. x, y and z are written only where they say something: w then has
// OVC_SAYS_MORE as well; else they stand for OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_LEAF. (llvmpipe stores word by word and lane
// by lane: four words a ray took a tenth of the time.)
#define OVC_SAYS_MORE 0x80000000u
#define OVC_LOCATION_PLANE 0 // of the uniform that says how many words a plane has
#define OVC_LOCATION_RAYS 2  // of the one that says how many rays the pass has

#define OVC_BINDING_RAYS 1
#define OVC_BINDING_ANSWERS 2
#define OVC_BINDING_PORTALS 3
// A word a leaf, not 0 where a ray was traced through its page.
#define OVC_BINDING_ACTIVE 4
#define OVC_BINDING_POOL 5 // and the next, one for each buffer of the pool
// The systems of the thesis: a ray is two texels, origin xyz, end t (negative: no ray); direction xyz, the index of the
// triangle it does not see. It begins at t = 0, in the frame of the whole scene, or of a leaf. In fast precision x, y, z of its answer
// are t, u, v (float bits).
#define OVC_FRAME_RAY_TEXELS 2
#define OVC_QUEUE_ROW_RAYS 256 // the thesis' two-level: rays lie in rows of so many
// Where a ray stands between passes (3 textures), and the scene (from here on).
#define OVC_BINDING_STATE 3
#define OVC_BINDING_SCENE 6

// Invocations of a work group of the compute kernel; a row of rays is a multiple.
#define OVC_GROUP_SIZE 64
// Groups that stay together, and into how many slices the others are dealt, where groups are dealt out (config.glsl).
#define OVC_DEALT_GROUPS 4
#define OVC_DEALT_SLICES 16

// The error bound, in units of u = 2^-24 (docs/design/numerics.md): a projected corner p is off by at most
// u (OVC_BOUND_CONSTANT + OVC_BOUND_RELATIVE (|x| + |y| + |z|)).
#define OVC_BOUND_UNIT 5.9604644775390625e-8
#define OVC_BOUND_CONSTANT 6.0
#define OVC_BOUND_RELATIVE 11.0
// Of weights that are off by a share s of their sum: by how much an average may move, 2 s, and the roundings of s itself.
#define OVC_BOUND_SHARE 2.00001

// Farther than this from a leaf, in leaf sizes, a ray's place of entry is off by more than 1/64 of a float rounding.
#define OVC_MAX_LEAF_SIZES 2097152.0

#endif
