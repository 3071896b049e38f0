// SPDX-License-Identifier: Apache-2.0
// The layout of pages, rays and answers, and the constants of the error bound. C++ and GLSL both
// include this file, so it has only preprocessor lines and comments.
#ifndef OVC_LAYOUT_H
#define OVC_LAYOUT_H

// A page is an array of units of 4 RGBA32UI texels (64 bytes): a header, then inner nodes and
// triangle pairs.
//
// header  texel 0: the grid's middle xyz (float bits), 0
//         texel 1: grid cell xyz (float bits), 0
//         texel 2: the traversal's first state: the root's unit, -1 (the stack's height, less one),
//                  0 (no word), 0
//         texel 3: OVC_HAS_LOOSE_PAIRS or 0, 0, 0, 0
// node    texels 0..2: per axis, the grid coordinates of four children's boxes:
//                      lo0|lo1<<16, lo2|lo3<<16,
//                      hi0|hi1<<16, hi2|hi3<<16; signed 16-bit, in cells from the grid's middle.
//                      The kernel reads an upper half with the lower one as its fraction, so lo1
//                      and lo3 are stored one less. A missing child has the max lo and the min hi.
//         texel 3: unit of the first child (children are contiguous), 0, 0, 0
// pair    texels 0..3: corners v0 v1 v2 v3 (float bits) of the triangles A = (v0, v1, v2) and
//         B = (v0, v3, v2); w of texel 0: number of A; w of texel 1: that of B or OVC_NO_TRIANGLE;
//         w of texel 3: OVC_PAIR; w of texel 2: which of the triangle's own corners v0 and v2 are,
//         two bits each, A's then B's
// loose   a pair of triangles that share no side, with OVC_LOOSE_PAIR set as well. Coordinates are
// pair    signed 24-bit numbers of OVC_LOOSE_STEP; corners are in the triangles' own order.
//         texels 0..3: corners A0 A1 A2 B0 in the upper 24 bits of x, y, z;
//         B1 and x of B2 each in the low bytes of x, y, z of a texel, the lowest byte in x;
//         y of B2 in the upper 24 bits of w of texel 2; z of B2 in the low byte of that w (its
//         highest byte) and in the low 16 bits of w of texel 3. The numbers of A and B as above.
#define OVC_UNIT_TEXELS 4
#define OVC_UNIT_BYTES 64
#define OVC_ROOT_UNIT 1
#define OVC_PAIR 0x80000000u
#define OVC_LOOSE_PAIR 0x40000000u
#define OVC_LOOSE_STEP 1.1920928955078125e-7 // 2^-23
#define OVC_LOOSE_TEXEL 3                    // of the header
#define OVC_HAS_LOOSE_PAIRS 1u
#define OVC_OWN_ORDER 0x88u // v0 and v2 of both triangles are their own corners 0 and 2
#define OVC_NO_TRIANGLE 0xffffffffu
// A unit's number within its buffer has at most so many bits; if the pool is one buffer, a stack
// word has no room for more.
#define OVC_MAX_BUFFER_BITS 25
#define OVC_MAX_PAGE_UNITS (1 << OVC_MAX_BUFFER_BITS)

// Under the top-level tree (gpu/page/top_level.h) units count from the pool's first, where the tree
// lies; elsewhere they count from the page's own first. If the pool is several buffers, the low
// bits of a unit's number are its number within its buffer and the bits above name the buffer
// (gpu/page/residency.h). The tree's lowest nodes are links, copies of pages' nodes; texel 3 of a
// link: the unit of the first child in the pool, or OVC_LEADS_NOWHERE; 1 + the page's leaf; the
// first child's unit in the page; 0. For a ray that meets it a link has a key, which orders links:
// the upper half of the bits of the t in the tree's frame (a float, 0 if it is negative), and below
// it 1 + the leaf.
#define OVC_LEADS_NOWHERE 0
#define OVC_KEY_LEAF 0xffff

// If pages lie in several frames, the tree's lowest nodes are portals; a ray that meets any of the
// up to four boxes of such a node goes through the portal. The parts' trees follow the top-level
// tree, each with a header of its own. Texel 3 of a portal's node: the portal's number, negated; 0,
// 0, 0. Each entry of the table of portals has OVC_PORTAL_TEXELS texels; number 0 is the way back
// to the top-level tree. A double is two words, the low one first.
//
// portal  texels 0 to 5: 12 doubles, the point of the world that lies at 0 in the frame, and the
//         rows of the matrix from the world to the frame
//         texels 6 and 7: the box of what lies behind it, in the frame, from xyz to xyz (float
//         bits); the unit of the tree's header; the number of the first triangle
#define OVC_PORTAL_TEXELS 8

// A ray is two RGBA32UI texels, in the frame that pages share: org xyz, t_end (float bits); dir xyz
// (float bits), the number of the triangle that it does not see or OVC_SKIPS_NONE, with
// OVC_RAY_ANY_HIT added if any hit will do. It begins at t = 0. A t_end of OVC_NO_RAY means that
// there is no ray, OVC_UNDECIDABLE that only doubles can answer it; both are closer to 0 than any t
// of a box.
#define OVC_LOCAL_RAY_TEXELS 2
#define OVC_RAY_ANY_HIT 0x80000000u
#define OVC_SKIPS_NONE 0x7fffffffu
#define OVC_NO_RAY -1.1754943508222875e-38f // -2^-126
#define OVC_UNDECIDABLE -2.350988701644575e-38f
// If not all pages are in the pool, a third texel has the key of the link that the ray waited for,
// 0 for none; 0, 0, 0. The ray is done with the links that it meets before that one.
#define OVC_RESUMED_RAY_TEXELS 3
// Under portals a ray is five texels: the record of core/ray.h, org, t_min, dir, t_max (doubles;
// t_max < t_min: no ray here); then 0, 0, the number of the triangle that it does not see or
// OVC_NO_TRIANGLE, and the key or 0, with OVC_RAY_ANY_HIT added.
#define OVC_RAY_TEXELS 5

// The answers of the fragment kernel are a texture. Rays lie in it in tiles of 4 x 4, in rows of
// tiles, so that fragments that a driver shades together are consecutive rays.
#define OVC_ROW_RAYS 64
#define OVC_TILE 4

// An answer is RGBA32UI; triangles are named by their numbers in the soup. z: the key of the link
// that the ray waits for, or OVC_NO_LEAF. w: the certain nearest hit in all pages that the ray met
// before that link, or
//   OVC_MISS      none
//   OVC_FLAGGED   the kernel cannot tell; y: a t (float bits) in the tree's frame, before which
//                 the ray hits nothing in all pages that it met
//   OVC_ENDED     none; behind x and y the ray was not traced on. If it hits neither, the kernel
//                 cannot tell
//   OVC_CAPPED    a loop was ended before it was done, or the stack was full
// x, y: up to two more candidates, which may be hit nearer than w, or OVC_NO_TRIANGLE. A triangle
// that is named neither in w nor here is certainly not the answer. Where there are more of them, up
// to OVC_MAX_NAMES, the compute kernel names them all where the ray was, in its first two texels;
// x: OVC_LISTED; y: the number of that ray in the pass, and in the lowest OVC_LIST_BITS their
// number. In fast precision w alone says something, and is not certain.
#define OVC_NO_LEAF 0x7fffffffu
#define OVC_MISS 0x7fffffffu
#define OVC_FLAGGED 0x7ffffffeu
#define OVC_CAPPED 0x7ffffffdu
#define OVC_ENDED 0x7ffffffcu
#define OVC_LISTED 0x7ffffffbu
#define OVC_MAX_NAMES 8
#define OVC_LIST_BITS 4
// How many candidates an answer may name besides the certain hit: 2, or OVC_MAX_NAMES. Each beyond
// two is a register and takes 1/3 % of a nearest ray's time on llvmpipe; a ray with more than can
// be named is traced again on the CPU, which takes four times as long as the kernel.
#ifndef OVC_NAMES
#define OVC_NAMES 2
#endif
#define OVC_MAX_TRIANGLES 0x7ffffff0u
// The compute kernel writes its answers to a buffer in four planes, w x y z, one word a ray, in the
// order of the rays. It does not write a miss without candidates, because the host has put OVC_MISS
// there. It writes x, y and z only if they say something, and then adds OVC_SAYS_MORE to w; else
// they stand for OVC_NO_TRIANGLE, OVC_NO_TRIANGLE, OVC_NO_LEAF. (llvmpipe stores word by word and
// lane by lane: four words a ray took a tenth of the time.)
#define OVC_SAYS_MORE 0x80000000u
#define OVC_LOCATION_PLANE 0 // of the uniform with the number of words in a plane
#define OVC_LOCATION_RAYS 2  // of the uniform with the number of rays in the pass
#define OVC_LOCATION_LANE_RAYS 3 // of the uniform with how many rays a subgroup claims for a lane

#define OVC_BINDING_SHARES 0 // of the atomic counter of claimed shares
#define OVC_BINDING_NAMES 0 // the rays once more, to write names in their places
#define OVC_BINDING_RAYS 1
#define OVC_BINDING_ANSWERS 2
#define OVC_BINDING_PORTALS 3
// One word for each leaf, not 0 if a ray was traced through its page.
#define OVC_BINDING_ACTIVE 4
#define OVC_BINDING_POOL 5 // and the following ones, one for each buffer of the pool
// In the systems of the thesis a ray is two texels: origin xyz, end t (negative: no ray); direction
// xyz, the index of the triangle that it does not see. It begins at t = 0, in the frame of the
// whole scene or of a leaf. In fast precision x, y, z of its answer are t, u, v (float bits).
#define OVC_FRAME_RAY_TEXELS 2
#define OVC_QUEUE_ROW_RAYS 256 // rays in a row of the texture of the thesis' two-level
// The state of rays between passes (3 textures), and the scene (from its binding on).
#define OVC_BINDING_STATE 3
#define OVC_BINDING_SCENE 6

// Max invocations in a work group of the compute kernel. A block of rays is a multiple of it, also
// where an invocation takes two rays.
#define OVC_MAX_GROUP_SIZE 128

// Invocations in a work group of the kernel that gpu/tuning/float_pair_check.h runs.
#define OVC_CHECKED_PAIRS 64

// The error bound, in units of u = 2^-24 (docs/design/numerics.md): a projected corner p is off by
// at most u (OVC_BOUND_CONSTANT + OVC_BOUND_RELATIVE (|x| + |y| + |z|)).
#define OVC_BOUND_UNIT 5.9604644775390625e-8
#define OVC_BOUND_CONSTANT 6.0
#define OVC_BOUND_RELATIVE 11.0
// If weights are off by a share s of their sum, an average moves by at most 2 s; the rest is for
// the roundings of s itself.
#define OVC_BOUND_SHARE 2.00001

// A ray that begins farther than this from a leaf, in leaf sizes, has a place of entry that is off
// by more than 1/64 of a float rounding.
#define OVC_MAX_LEAF_SIZES 2097152.0

#endif
