// SPDX-License-Identifier: Apache-2.0
// The generated dragon, in place of a scanned one: a coiling body with scales, crest, mane, horned
// head, four legs.
#pragma once

#include "testscenes/tube.h"

namespace ovc::dragons {

/// The fewest triangles that make_creature() takes.
inline constexpr uint64_t kMinCreature = 20'000;

/// Exactly `triangles`. It stands on y = 0 and looks along +x, about 2.4 long and 1.6 high. Every
/// part of it is closed, but for the tongue, which an odd number of triangles needs.
Surface make_creature(uint64_t triangles, bool with_normals);

} // namespace ovc::dragons
