// SPDX-License-Identifier: Apache-2.0
// The species of the plants scene, with their colours and makers.
#pragma once

#include "testscenes/plants/prototype.h"

#include <cstdint>
#include <span>

namespace ovc::plants {

enum class Kind : uint8_t {
    Oak,
    Maple,
    Birch,
    Willow,
    Spruce,
    Bush,
    Grass,
    Reed,
    Flower,
    Daisy,
    Lily,
    Rock
};

/// Colours are linear. A plant's tint is the number of one of `tints`.
struct Species {
    const char* name;
    Maker make;
    uint32_t variants;    // the number of different prototypes
    double fine_distance; // Full detail is worth its triangles within so many metres.
    vec3 wood;
    vec3 accent;
    std::span<const vec3> tints;
};

/// Returns the species in the order of Kind.
std::span<const Species> species();

} // namespace ovc::plants
