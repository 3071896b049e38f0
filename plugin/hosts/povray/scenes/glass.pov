// SPDX-License-Identifier: AGPL-3.0-or-later
// A mesh of glass: refraction, total reflection, and shadows that are light through it.
#include "stage.inc"
#declare Solid = <0.1, 1, 0.2>;
#include "bunny.inc"
camera { location <0.3, 1.3, -3> look_at <0, 0.55, 0> angle 38 }
Sun()
Floor()
sphere { <-0.9, 0.5, 0.9>, 0.5 pigment { rgb <0.8, 0.3, 0.2> } }
object { Stand(bunny, 1.2, 170) pigment { rgbt <0.95, 1, 0.95, 0.9> } finish { specular 0.7 reflection { 0.02, 0.5 fresnel } conserve_energy } interior { ior 1.5 fade_distance 1 fade_power 2 fade_color <0.6, 0.9, 0.7> } }
