// SPDX-License-Identifier: Apache-2.0
// Scenes get an exposure, because pbrt writes pictures of any range but ours end at white.
#pragma once

#include "core/scene.h"

namespace ovc::pbrt {

/// Measures how bright a picture of triangles becomes that come in parts.
class ExposureMeter {
public:
    /// The scene's camera, lights and materials must be there; so many triangles are to come.
    ExposureMeter(const Scene& scene, uint64_t triangles);

    /// Adds the next triangles, in order.
    void add(const Chunk& chunk, const Material& material);
    /// Returns what fitting_exposure() does.
    float exposure() const;

private:
    const Scene& scene_;
    const uint64_t step_;
    uint64_t number_ = 0; // of the triangle that comes next
    double weights_ = 0, sum_ = 0;
};

/// Returns the factor on the scene's light with which a picture from its camera is neither white
/// nor black; 1 if it is fine as it is, or has no camera or no lights. It is a guess from the light
/// that reaches the triangles in view, without shadows.
float fitting_exposure(const Scene& scene);

/// Multiplies the light of lights, sky and emitters.
void expose(Scene& scene, const vec3& exposure);

} // namespace ovc::pbrt
