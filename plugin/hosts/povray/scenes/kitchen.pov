// SPDX-License-Identifier: AGPL-3.0-or-later
// A room of many meshes, each of its own color, some of them glossy; a soft light.
#include "stage.inc"
#include "kitchen.inc"
#local Low = min_extent(kitchen);
#local Size = max_extent(kitchen) - Low;
camera { location Low + <0.5, 0.6, 0.5> * Size look_at Low + <0.9, 0.3, 0.15> * Size angle 75 }
light_source { Low + <0.6, 0.9, 0.5> * Size rgb 0.9 area_light 0.1 * Size.x * x, 0.1 * Size.x * z, 3, 3 }
light_source { Low + <0.9, 0.8, 0.3> * Size rgb 0.4 shadowless }
background { rgb 0.6 }
object { kitchen }
