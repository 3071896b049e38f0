// SPDX-License-Identifier: Apache-2.0
// Rays and answers as the kernels of the thesis have them (shaders/layout.h), in the frame that
// holds the whole scene.
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/partition.h"

#include <array>
#include <bit>
#include <cstdint>

namespace ovc::thesis {

/// A ray in the frame, which begins at t = 0.
struct FrameRay {
    vec3 org{0};
    float t_end = -1;  // negative: no ray
    vec3 dir{0, 0, 1}; // largest component 1 or -1
    uint32_t skip = kNone;
};
static_assert(sizeof(FrameRay) == 32);

/// prim is an index into the triangles of the scene, OVC_MISS, OVC_FLAGGED or OVC_CAPPED.
struct FrameAnswer {
    std::array<uint32_t, 3> words;
    uint32_t prim;

    /// If certified: triangles that may be the answer as well, or OVC_NO_TRIANGLE.
    std::array<uint32_t, 2> further() const { return {words[0], words[1]}; }
    /// These return t, u and v. Only in fast precision.
    float t() const { return std::bit_cast<float>(words[0]); }
    float u() const { return std::bit_cast<float>(words[1]); }
    float v() const { return std::bit_cast<float>(words[2]); }
};
static_assert(sizeof(FrameAnswer) == 16);

/// Returns the ray in the scene's frame, from where it enters the scene's box; no ray where it does
/// not. decidable becomes false where double precision cannot say where it enters to within 1/64 of
/// a float rounding (docs/design/numerics.md, "Frames").
FrameRay frame_ray(const Leaf& whole, const PreparedRay& p, bool& decidable);

/// Returns the host's t of the kernel's t_frame on the ray that frame_ray() made of p.
double world_t(const Leaf& whole, const PreparedRay& p, float t_frame);

} // namespace ovc::thesis
