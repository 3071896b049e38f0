// SPDX-License-Identifier: Apache-2.0
// Every switch of the kernel, with its default. ShaderConfig (gpu/gl/kernel.h) always defines all of them.

#ifndef OVC_ANY_HIT
#define OVC_ANY_HIT 0 // 1: all rays ask whether anything is hit; 0: each says what it asks, those of the thesis the nearest hit
#endif
#ifndef OVC_CERTIFY
#define OVC_CERTIFY 1 // 0: fast precision, float32's own answer, nothing flagged but what did not end
#endif
#ifndef OVC_PORTALS
#define OVC_PORTALS 0 // 1: the top-level tree leads to parts in frames of their own, and rays come in doubles
#endif
#ifndef OVC_MAY_WAIT
#define OVC_MAY_WAIT 0 // 1: a ray waits where a link leads to a page that is not in the pool
#endif
#ifndef OVC_TELL_ACTIVE
#define OVC_TELL_ACTIVE 0 // 1: pages that rays are traced through are marked
#endif
#ifndef OVC_POOL_BUFFERS
#define OVC_POOL_BUFFERS 1 // that the pool consists of
#endif
#ifndef OVC_EACH_BUFFER
#define OVC_EACH_BUFFER(do_with) do_with(0) // and with each number below OVC_POOL_BUFFERS
#endif
#ifndef OVC_BUFFER_BITS
#define OVC_BUFFER_BITS 25 // of a unit's number, those within a buffer; above them the buffer's number
#endif
#ifndef OVC_LOOSE_PAIRS
#define OVC_LOOSE_PAIRS 0 // 1: a page may hold two triangles that share no side in a unit
#endif
#ifndef OVC_STACK_DEPTH
#define OVC_STACK_DEPTH 16 // words; one less than the page's depth loses no ray. A register each on llvmpipe: 1 % of the time
#endif
#ifndef OVC_STACK_REGISTERS
#define OVC_STACK_REGISTERS 1 // 1: the stack is selected from by comparisons, for drivers that branch per lane on
                              // indexed writes (llvmpipe: 4 to 25 % faster); 0: a plain array
#endif
#ifndef OVC_PACKET
#define OVC_PACKET 1 // rays that an invocation traces together
#endif
#ifndef OVC_REFILL
#define OVC_REFILL 0 // 1: a subgroup has more rays, or packets, than lanes, which take them in turn (GL_ARB_shader_ballot)
#endif
#ifndef OVC_BRANCHES
#define OVC_BRANCHES 0 // 1: a step runs what its unit is for; 0: for drivers that run both sides of a branch (llvmpipe)
#endif
#ifndef OVC_DEAL_GROUPS
#define OVC_DEAL_GROUPS 1 // 1: neighbouring work groups go to different threads of a driver that gives each a contiguous share
                          // of the dispatch (llvmpipe: 8 % of camera rays); with ray refill groups are too few for it
#endif
#ifndef OVC_BUFFER_IMAGES
#define OVC_BUFFER_IMAGES 1 // pages, portals, rays: 1: imageLoad (inlined on llvmpipe, 5 % faster); 0: texelFetch
#endif
#if OVC_BUFFER_IMAGES
#define OVC_TEXELS(number) layout(rgba32ui, binding = number) uniform readonly restrict uimageBuffer
#define OVC_TEXEL(texels, i) imageLoad(texels, i)
#else
#define OVC_TEXELS(number) layout(binding = number) uniform usamplerBuffer
#define OVC_TEXEL(texels, i) texelFetch(texels, i)
#endif
#ifndef OVC_MAX_ROUNDS
#define OVC_MAX_ROUNDS 0x7fffffff // a ray's loops end after so many rounds and say so, before a driver ends them silently
#endif
