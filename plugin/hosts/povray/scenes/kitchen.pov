// SPDX-License-Identifier: AGPL-3.0-or-later
// A room of many meshes, each of its own color, some of them glossy; a soft light.
#include "stage.inc"
#include "kitchen.inc"
#local Low = min_extent(kitchen);
#local High = max_extent(kitchen);
#local Middle = (Low + High) / 2;
camera { location Middle + <0.9, 0.55, -0.9> * vlength(High - Low) look_at Middle angle 40 }
light_source { Middle + <-0.4, 1.5, -0.7> * vlength(High - Low) rgb 1 area_light 20 * x, 20 * z, 3, 3 }
light_source { Middle + <1, 0.8, -1> * vlength(High - Low) rgb 0.5 }
background { rgb 0.6 }
object { kitchen }
