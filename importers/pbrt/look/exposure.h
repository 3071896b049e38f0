// SPDX-License-Identifier: Apache-2.0
// Scenes get an exposure, because pbrt writes pictures of any range but ours end at white.
#pragma once

#include "core/scene.h"

namespace ovc::pbrt {

/// Returns the factor on the scene's light with which a picture from its camera is neither white
/// nor black; 1 if it is fine as it is, or has no camera or no lights. It is a guess from the light
/// that reaches the triangles in view, without shadows.
float fitting_exposure(const Scene& scene);

/// Multiplies the light of lights, sky and emitters.
void expose(Scene& scene, float exposure);

} // namespace ovc::pbrt
