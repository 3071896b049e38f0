// SPDX-License-Identifier: Apache-2.0
// Light that lamps throw like slides: a picture of all their ways, or one in a window before them.
#pragma once

#include "core/scene.h"

namespace ovc {

/// Returns what the light's color is multiplied by at the position: its picture's color there, 0
/// beside its window, and 1 if it throws no picture.
/// Based on: Pharr and Humphreys 2004, sections 13.2.2 and 13.2.3, goniophotometric and projection
/// lights.
vec3 thrown_color(const Scene& scene, const Light& light, const dvec3& position);

} // namespace ovc
