// SPDX-License-Identifier: AGPL-3.0-or-later
// Photons through a mesh, and an orthographic camera.
#include "stage.inc"
#declare Solid = <0.1, 1, 0.2>;
#include "bunny.inc"
global_settings { photons { spacing 0.02 } }
camera { orthographic location <0, 2.2, -3> look_at <0.1, 0.5, 0> right 2.6 * x up 1.95 * y }
light_source { <-3, 5, -2> rgb 1.3 photons { refraction on reflection on } }
background { rgb <0.2, 0.25, 0.35> }
plane { y, 0 pigment { rgb 0.8 } photons { collect on } }
object { Stand(bunny, 1, 170) pigment { rgbf <0.9, 0.95, 1, 0.9> } finish { specular 0.6 reflection 0.05 } interior { ior 1.4 } photons { target refraction on reflection on } }
