// SPDX-License-Identifier: Apache-2.0
// Exposure: pbrt writes pictures of any range, ours end at white.
#pragma once

#include "core/scene.h"

namespace ovc::pbrt {

/// What the scene's light should be multiplied by for a picture from its camera to be neither
/// white nor black: 1 where it is fine as it is. A guess from the light that reaches the triangles
/// in view, without shadows.
float fitting_exposure(const Scene& scene);

/// Multiplies lights, sky and emitters.
void expose(Scene& scene, float exposure);

} // namespace ovc::pbrt
