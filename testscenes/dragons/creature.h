// SPDX-License-Identifier: Apache-2.0
// The generated dragon, which replaces a scanned one: a coiling body with scales, crest, mane,
// horned head and four legs.
#pragma once

#include "testscenes/tube.h"

namespace ovc::dragons {

/// make_creature() takes at least so many triangles.
inline constexpr uint64_t kMinCreature = 20'000;

/// Makes a dragon of exactly `triangles`. It stands on y = 0 and looks along +x, about 2.4 long and
/// 1.6 high. Every part of it is closed, except the tongue, which an odd number of triangles needs.
Surface make_creature(uint64_t triangles, bool with_normals);

} // namespace ovc::dragons
