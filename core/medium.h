// SPDX-License-Identifier: Apache-2.0
// Medium: smoke, clouds and light that fill a solid or the air, as POV-Ray's media.
#pragma once

#include "core/texture/texture.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// The three colors say what happens to light on a unit of length where the density is 1.
struct Medium {
    /// How scattered light is spread over directions; Even scatters into all alike.
    enum class Phase : uint64_t { Even, MieHazy, MieMurky, Rayleigh, HenyeyGreenstein };

    vec3 absorption{0};   // light that is lost
    vec3 emission{0};     // light that is added
    vec3 scattering{0};   // light that turns towards the ray from the lights
    float extinction = 1; // the share of scattered light that is missing on its way
    Phase phase = Phase::Even;
    float eccentricity = 0; // of HenyeyGreenstein: above 0 forwards, below 0 backwards; within 1
    std::vector<PlacedTexture> densities; // the product of their colors is the density; none: 1
    uint32_t samples = 16;                // at least 1: places along a ray that are looked at

    bool operator==(const Medium&) const = default;
};

} // namespace ovc
