// SPDX-License-Identifier: Apache-2.0
// Medium: smoke, clouds and light that fill a solid or the air, as POV-Ray's media.
#pragma once

#include "core/texture/texture.h"

#include <cstdint>
#include <vector>

namespace ovc {

inline constexpr uint32_t kMaxMediumLevels = 12; // Medium::levels

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
    /// How closely rays look (media.h): the intervals of a way where light is scattered, the parts
    /// of an interval, each at least 1, and how often a part may be halved, which it is where the
    /// light that comes from its ends and its middle differs by more than the threshold, all
    /// colors together. With 0 levels a part is looked at in its middle.
    uint32_t intervals = 1;
    uint32_t samples = 6;
    uint32_t levels = 3;
    float threshold = 0.1f;

    bool operator==(const Medium&) const = default;
};

} // namespace ovc
