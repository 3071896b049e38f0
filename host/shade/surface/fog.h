// SPDX-License-Identifier: Apache-2.0
// The fog and the rainbows that light goes through on its way to a ray's origin.
#pragma once

#include "core/ray.h"
#include "core/scene.h"

#include <span>

namespace ovc {

/// The shares of light, for each color, that come through fog, and the light that the fog adds.
struct ThroughFog {
    vec3 share{1};
    vec3 added{0};
};

/// Returns what the fogs do on the ray's way up to `t`, or on an endless way for an infinite one.
ThroughFog through_fog(std::span<const Fog> fogs, const Ray& ray, double t);

/// Does the same for rainbows.
ThroughFog through_rainbows(std::span<const Rainbow> bows, const Ray& ray, double t);

} // namespace ovc
