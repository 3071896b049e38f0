// SPDX-License-Identifier: Apache-2.0
// One variant of the kernel in C++. The build compiles this file once for each: REPLAY names the
// function, and the kernel's switches are defines.
#include "tests/warp/replayed_kernel.h"

#include "tests/warp/glsl.h"

namespace ovc_replay::REPLAY_NAMESPACE {

using namespace glsl;

#define OVC_STACK_DEPTH 64
#define OVC_STACK 0
#define OVC_REFILL 0
#define OVC_LOOSE_PAIRS 1
#define OVC_COUNTS 1
#define OVC_MAX_ROUNDS 65000
#include "kernel_as_cpp.inc"

namespace {

// The state of the slot that this thread replays.
thread_local std::span<const ovc::uvec4> pool;
thread_local std::span<const ovc::uvec4> ray_texels;
thread_local ovc::Steps* steps = nullptr;
thread_local int first_ray = 0;

uvec4 texel(std::span<const ovc::uvec4> texels, size_t i) {
    const ovc::uvec4& t = texels[i];
    return {t.x, t.y, t.z, t.w};
}

} // namespace

Unit unit_at(int unit) {
    const size_t at = size_t(unit) * OVC_UNIT_TEXELS;
    const Unit found(texel(pool, at), texel(pool, at + 1), texel(pool, at + 2),
                     texel(pool, at + 3));
    steps->units.push_back(uint(unit));
    steps->is_pair.push_back(is_pair(found));
    return counted(found);
}

uvec4 ray_texel(int i) {
    return texel(ray_texels, size_t(i));
}

void give(int ray, uvec4 answer) {
    (ray == first_ray ? steps->prim : steps->second_prim) = answer.w;
    steps->rounds = answer.x;
}

ovc::Steps replay_slot(std::span<const ovc::uvec4> pool_texels, std::span<const ovc::LocalRay> rays,
                       size_t first) {
    ovc::Steps found;
    pool = pool_texels;
    ray_texels = {reinterpret_cast<const ovc::uvec4*>(rays.data()), 2 * rays.size()};
    steps = &found;
    first_ray = int(first);
    units_fetched = 0;
    trace_once(int(first), OVC_MAX_ROUNDS);
    return found;
}

} // namespace ovc_replay::REPLAY_NAMESPACE
