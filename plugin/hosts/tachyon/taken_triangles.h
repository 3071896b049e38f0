// SPDX-License-Identifier: Apache-2.0
// One object of Tachyon's that stands for all triangles of a scene: Overcast finds the nearest,
// everything else stays Tachyon's.
#pragma once

#include "plugin/hosts/tachyon/single_rays.h"
#include "plugin/hosts/tachyon/tachyon_triangle.h"

#include <cstddef>

namespace ovc::tachyon {

struct Taken {
    size_t triangles = 0;             // taken from the scene by this call
    size_t left = 0;                  // whose corners no float holds: they stay Tachyon's
    const SingleRays* rays = nullptr; // lives as long as the scene; null where none were taken
};

/// Takes the triangles out of the scene's list and puts an object in their place that has Overcast
/// find the nearest on a ray and then has Tachyon's own test decide: its t, its EPSILON, clipping
/// planes, shadows and their filters are Tachyon's, and so are normals and textures, as the
/// intersection names Tachyon's own triangle. The object frees them with the scene. Triangles whose
/// corners are not floats stay in the list, since Overcast keeps floats and the picture must be
/// the same. Throws std::runtime_error with a sentence, the scene as it was.
Taken take_triangles(scenedef& scene, Intersect triangle_intersect, const Settings& settings);

} // namespace ovc::tachyon
