// SPDX-License-Identifier: Apache-2.0
// The generators behind the catalog, one per scene family. Sizes lie in the catalog's range; the
// catalog names the scene.
#pragma once

#include "testscenes/camera_path.h"

#include <cstdint>

namespace ovc {

/// The size of plants-N that is `plants`; N counts 110,000 triangles, roughly.
inline constexpr double kPlantsDemoSize = 64;

Scene make_plants(uint32_t size);
/// 100,000 leaves, cut out of quads by a picture; or modelled.
Scene make_leaf_canopy();
Scene make_modelled_leaf_canopy();
/// What moves, at a clock from 0 to 1.
Scene make_cloth(double clock);
Scene make_grass_in_wind(double clock);
Scene make_terrain(uint32_t cells);
Scene make_far_terrain();
Scene make_sphere_scene(uint32_t level);
Scene make_knot();
Scene make_soup(uint32_t thousands);
Scene make_city();
Scene make_fractal();
Scene make_mirrors();
Scene make_glass();
Scene make_box();

inline constexpr uint32_t kMaxDragons = 21;
/// model: shown instead of the generated dragon; null: none. At least one of its triangles can be
/// hit.
Scene make_dragons(uint32_t count, const Soup* model);
Scene make_dragonball(const Soup* model);

inline constexpr uint32_t kPowerplantTriangles = 12'748'510; // as the one of UNC
/// Exactly so many triangles, one less where that is odd.
Scene make_powerplant(uint32_t triangles);

// The camera paths of the thesis, one a scene.
CameraPath dragons_path(uint32_t count);
CameraPath dragonball_path();
CameraPath plants_path();
CameraPath powerplant_path(uint32_t triangles);

} // namespace ovc
