// SPDX-License-Identifier: Apache-2.0
// The generators behind the catalog, one per scene family. Sizes lie in the catalog's range; the
// catalog names the scene.
#pragma once

#include "core/scene.h"

#include <cstdint>

namespace ovc {

/// The size of plants-N that is `plants`; N counts 110,000 triangles, roughly.
inline constexpr double kPlantsDemoSize = 64;

Scene make_plants(uint32_t size);
Scene make_terrain(uint32_t cells);
Scene make_far_terrain();
Scene make_sphere_scene(uint32_t level);
Scene make_knot();
Scene make_soup(uint32_t thousands);
Scene make_city();
Scene make_mirrors();
Scene make_box();

} // namespace ovc
