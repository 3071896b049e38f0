// SPDX-License-Identifier: Apache-2.0
// Gathers all hits of a ray in one walk of the pages in host memory.
#pragma once

#include "core/sieve.h"
#include "plugin/build/built_scene.h"

#include <vector>

namespace ovc {

/// Returns all hits of a valid ray that are not excluded, in the order of t, mesh and prim, as
/// exact arithmetic has it. Each hit's t, u and v are rounded once. It takes O(n log n) time for n
/// triangles near the ray. Any thread.
std::vector<Hit> gathered_hits(const BuiltScene& scene, const PreparedRay& p);

/// A ray that has passed by so many hits, which do not count, gets the others gathered: were it to
/// go on from one to the next, each step would meet again all those that lie in one point.
inline constexpr uint8_t kMaxPassedBy = 32;

/// Returns the first of the gathered hits that counts by the sieve; a miss where none does.
Hit first_counting_hit(const BuiltScene& scene, const PreparedRay& p, const RaySieve& sieve);

} // namespace ovc
