// SPDX-License-Identifier: Apache-2.0
// One object of Tachyon's that stands for all triangles of a scene: Overcast finds the nearest,
// everything else stays Tachyon's.
#pragma once

#include "plugin/hosts/tachyon/single_rays.h"
#include "plugin/hosts/tachyon/tachyon_triangle.h"

namespace ovc::tachyon {

/// Takes the triangles out of the scene's list and puts an object in their place that has Overcast
/// find the nearest on a ray and then has Tachyon's own test decide: its t, its EPSILON, clipping
/// planes, shadows and their filters are Tachyon's, and so are normals and textures, as the
/// intersection names Tachyon's own triangle. The object frees them with the scene.
/// Returns what answers, alive as long as the scene; null where there are no triangles. Throws
/// std::runtime_error with a sentence, the scene as it was.
const SingleRays* take_triangles(scenedef& scene, Intersect triangle_intersect,
                                 const Settings& settings);

} // namespace ovc::tachyon
