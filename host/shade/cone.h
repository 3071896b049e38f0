// SPDX-License-Identifier: Apache-2.0
// Based on: Amanatides 1984, "Ray Tracing with Cones".
#pragma once

namespace ovc {

/// The cone that a ray stands for: its diameter where the ray begins, and by how much that grows
/// over a unit of length. Of textures, a hit sees the mean over the cone.
struct Cone {
    float width = 0;
    float spread = 0;

    float width_at(double distance) const { return width + spread * float(distance); }
};

} // namespace ovc
