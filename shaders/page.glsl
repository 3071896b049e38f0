// SPDX-License-Identifier: Apache-2.0
// Texels of the pool that pages lie in.

#if OVC_TELL_ACTIVE
layout(r32ui, binding = OVC_BINDING_ACTIVE) uniform writeonly restrict uimageBuffer active_leaves;
void mark_active(int leaf) { imageStore(active_leaves, leaf, uvec4(1u)); }
#endif

#if OVC_BUFFER_IMAGES
layout(rgba32ui, binding = OVC_BINDING_PAGE) uniform readonly restrict uimageBuffer page;
uvec4 page_texel(int i) { return imageLoad(page, i); }
#else
layout(binding = OVC_BINDING_PAGE) uniform usamplerBuffer page;
uvec4 page_texel(int i) { return texelFetch(page, i); }
#endif
