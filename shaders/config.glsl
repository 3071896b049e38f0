// SPDX-License-Identifier: Apache-2.0
// Every switch of the kernel, with its default. ShaderConfig (gpu/gl/kernel.h) always defines all
// of them.

// 1: all rays ask whether anything is hit; 0: each ray says what it asks, and those of the thesis
// ask for the nearest hit.
#ifndef OVC_ANY_HIT
#define OVC_ANY_HIT 0
#endif
// 0: fast precision names the triangle that float32 finds nearest, and flags nothing except rays
// whose loops were ended.
#ifndef OVC_CERTIFY
#define OVC_CERTIFY 1
#endif
// 1: the top-level tree leads to parts in frames of their own, and rays come in doubles.
#ifndef OVC_PORTALS
#define OVC_PORTALS 0
#endif
// 1: portals compute rays in pairs of floats, for devices on which doubles are slow; 0: in doubles.
#ifndef OVC_FLOAT_PAIRS
#define OVC_FLOAT_PAIRS 0
#endif
#ifndef OVC_MAY_WAIT
#define OVC_MAY_WAIT 0 // 1: a ray waits if a link leads to a page that is not in the pool
#endif
#ifndef OVC_TELL_ACTIVE
#define OVC_TELL_ACTIVE 0 // 1: the kernel marks pages that rays are traced through
#endif
#ifndef OVC_POOL_BUFFERS
#define OVC_POOL_BUFFERS 1 // the number of buffers of the pool
#endif
// Calls the macro do_with with each number below OVC_POOL_BUFFERS.
#ifndef OVC_EACH_BUFFER
#define OVC_EACH_BUFFER(do_with) do_with(0)
#endif
#ifndef OVC_BUFFER_BITS
#define OVC_BUFFER_BITS 25 // low bits of a unit's number; the bits above them name its buffer
#endif
#ifndef OVC_LOOSE_PAIRS
#define OVC_LOOSE_PAIRS 0 // 1: a unit may hold two triangles that share no side
#endif
// Words of the stack; one less than the page's depth loses no ray. Each is a register on llvmpipe
// and costs 1 % of the time.
#ifndef OVC_STACK_DEPTH
#define OVC_STACK_DEPTH 16
#endif
// 0: the stack is a plain array. 1: it lies in registers, from which comparisons select, for
// drivers that branch per lane on indexed writes (llvmpipe: 4 to 25 % faster). 2: it lies in shared
// memory (an NVIDIA H200: 12 to 19 % faster than in registers, and 1.3 to 4.7 times as fast as in
// an array).
#ifndef OVC_STACK
#define OVC_STACK 1
#endif
#ifndef OVC_PACKET
#define OVC_PACKET 1 // rays that an invocation traces together
#endif
// 1: a subgroup claims its rays from a counter (GL_ARB_shader_ballot).
#ifndef OVC_CLAIMS
#define OVC_CLAIMS 0
#endif
// 1: the lanes of a subgroup take the rays that it has claimed in turn, or packets of them.
#ifndef OVC_REFILL
#define OVC_REFILL 0
#endif
// 1: a step runs only the code for its kind of unit; 0: for drivers that run both sides of a branch
// (llvmpipe).
#ifndef OVC_BRANCHES
#define OVC_BRANCHES 0
#endif
// How pages, portals and rays are read. 0: by texelFetch; 1: by imageLoad (inlined on llvmpipe, 5 %
// faster); 2: from storage buffers. OVC_TEXELS declares such texels under a name of their own,
// OVC_SHARED_TEXELS those that the kernel may write to under another.
#ifndef OVC_READS
#define OVC_READS 1
#endif
#if OVC_READS == 2
#define OVC_TEXELS(number, block) \
    layout(std430, binding = number) readonly restrict buffer block { uvec4 words[]; }
#define OVC_SHARED_TEXELS(number, block) \
    layout(std430, binding = number) readonly buffer block { uvec4 words[]; }
#define OVC_TEXEL(texels, i) texels.words[i]
#elif OVC_READS == 1
#define OVC_TEXELS(number, block) \
    layout(rgba32ui, binding = number) uniform readonly restrict uimageBuffer
#define OVC_SHARED_TEXELS(number, block) \
    layout(rgba32ui, binding = number) uniform readonly uimageBuffer
#define OVC_TEXEL(texels, i) imageLoad(texels, i)
#else
#define OVC_TEXELS(number, block) layout(binding = number) uniform usamplerBuffer
#define OVC_SHARED_TEXELS OVC_TEXELS
#define OVC_TEXEL(texels, i) texelFetch(texels, i)
#endif
// Invocations in a work group of the compute kernel: OVC_MAX_GROUP_SIZE or a part of it.
#ifndef OVC_GROUP_SIZE
#define OVC_GROUP_SIZE 64
#endif
// 1: instead of further candidates an answer tells how many rounds its ray took, and how many units
// were fetched for it; for gpu/warp, and not with claims.
#ifndef OVC_COUNTS
#define OVC_COUNTS 0
#endif
// A ray's loops end after so many rounds and report it, before a driver ends them silently.
#ifndef OVC_MAX_ROUNDS
#define OVC_MAX_ROUNDS 0x7fffffff
#endif
