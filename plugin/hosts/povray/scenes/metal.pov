// SPDX-License-Identifier: AGPL-3.0-or-later
// Smooth normals, bumps and mirrors that see each other; depth of field off, an area light on.
#include "stage.inc"
#declare Smooth = 1;
#include "buddha.inc"
#include "dragon_small.inc"
camera { location <0.2, 1.2, -2.8> look_at <0, 0.6, 0> angle 42 }
light_source { <-4, 6, -5> rgb 1.2 area_light 1.5 * x, 1.5 * y, 4, 4 adaptive 1 }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.8, 0.8, 0.9>] [1 rgb <0.1, 0.2, 0.5>] } } }
Floor()
object { Stand(buddha, 1.3, 180) translate -0.5 * x pigment { rgb <0.9, 0.65, 0.25> } normal { bumps 0.15 scale 0.02 } finish { metallic ambient 0 diffuse 0.3 specular 0.8 reflection { 0.6 metallic } } }
object { Stand(dragon_small, 0.9, 30) translate <0.65, 0, 0.1> pigment { rgb <0.6, 0.6, 0.65> } finish { diffuse 0.2 specular 0.6 reflection 0.7 } }
