// SPDX-License-Identifier: Apache-2.0
// Species: which plants grow in the plants scene, their colours and how they are made.
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

/// Linear colours. A plant's tint is the number of one of `tints`.
struct Species {
    const char* name;
    Maker make;
    uint32_t variants;    // different prototypes
    double fine_distance; // within it the full detail is worth its triangles; metres
    vec3 wood;
    vec3 accent;
    std::span<const vec3> tints;
};

/// By Kind.
std::span<const Species> species();

} // namespace ovc::plants
