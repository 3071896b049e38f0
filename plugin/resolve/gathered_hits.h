// SPDX-License-Identifier: Apache-2.0
// Gathers all hits of a ray in one walk of the pages in host memory.
#pragma once

#include "plugin/build/built_scene.h"

#include <vector>

namespace ovc {

/// Returns all hits of a valid ray that are not excluded, in the order of t, mesh and prim, as
/// exact arithmetic has it. Each hit's t, u and v are rounded once. It takes O(n log n) time for n
/// triangles near the ray. Any thread.
std::vector<Hit> gathered_hits(const BuiltScene& scene, const PreparedRay& p);

} // namespace ovc
