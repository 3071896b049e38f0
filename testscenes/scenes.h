// SPDX-License-Identifier: Apache-2.0
// The generators behind the catalog, one for each scene family. Sizes lie in the catalog's range.
// The catalog names the scene.
#pragma once

#include "testscenes/camera_path.h"

#include <cstdint>

namespace ovc {

/// `plants` is plants-N of this size. N counts about 110,000 triangles.
inline constexpr double kPlantsDemoSize = 64;

Scene make_plants(uint32_t size);
/// Makes 100,000 leaves, which a picture cuts out of quads.
Scene make_leaf_canopy();
Scene make_modelled_leaf_canopy();
/// Makes a scene that moves, at a clock from 0 to 1.
Scene make_cloth(double clock);
Scene make_grass_in_wind(double clock);
Scene make_terrain(uint32_t cells);
Scene make_far_terrain();
/// Makes so many million triangles; landscape.h makes them in parts.
Scene make_landscape(uint32_t millions);
Scene make_sphere_scene(uint32_t level);
Scene make_knot();
Scene make_soup(uint32_t thousands);
Scene make_city();
inline constexpr uint32_t kFractalBalls = 25'250;
Scene make_fractal(uint32_t balls);
Scene make_mirrors();
Scene make_glass();
Scene make_box();

inline constexpr uint32_t kMaxDragons = 21;
/// model: shown instead of the generated dragon, or null. At least one of its triangles can be hit.
Scene make_dragons(uint32_t count, const Soup* model);
Scene make_dragonball(const Soup* model);

inline constexpr uint32_t kPowerplantTriangles = 12'748'510; // as many as UNC's power plant has
/// Makes exactly so many triangles, or one less if the number is odd.
Scene make_powerplant(uint32_t triangles);

// The camera paths of the thesis, one for each scene.
CameraPath dragons_path(uint32_t count);
CameraPath dragonball_path();
CameraPath plants_path();
CameraPath powerplant_path(uint32_t triangles);

} // namespace ovc
