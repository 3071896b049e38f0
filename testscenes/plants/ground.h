// SPDX-License-Identifier: Apache-2.0
// The ground and the water of the plants scene as triangles.
#pragma once

#include "testscenes/corners.h"

#include <array>
#include <cstdint>

namespace ovc::plants {

/// The covers of the ground. Each is a mesh of its own.
enum class Cover : uint8_t { Mud, Sand, Meadow, DryMeadow, ForestFloor, Stone, FarWood, FarRidge };
inline constexpr size_t kCovers = 8;

/// Makes cells x cells squares of two triangles, finer towards the viewer, sorted by cover.
std::array<Corners, kCovers> make_ground(uint32_t cells);

/// Makes the water, flat at y = 0, also below the land.
Corners make_water();

} // namespace ovc::plants
