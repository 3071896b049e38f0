// SPDX-License-Identifier: AGPL-3.0-or-later
// Smoke in a hollow mesh, and fog around it.
#include "stage.inc"
#declare Solid = <0.1, 1, 0.2>;
#include "bunny.inc"
#include "lucy.inc"
camera { location <0.3, 1.2, -3> look_at <0, 0.6, 0> angle 40 }
light_source { <-4, 7, -6> rgb 1.2 }
background { rgb <0.3, 0.4, 0.6> }
fog { fog_type 2 distance 12 rgb <0.6, 0.65, 0.7> fog_offset 0.1 fog_alt 0.4 }
Floor()
object { Stand(bunny, 1.2, 170) translate -0.5 * x hollow pigment { rgbt 1 } finish { specular 0.4 } interior { media { emission <0.3, 0.5, 0.9> absorption <1.2, 0.8, 0.5> intervals 1 samples 12, 12 method 3 jitter 0 density { gradient y color_map { [0 rgb 0.3] [1 rgb 2] } scale 1.2 } } } }
object { Stand(object { lucy rotate -90 * x }, 1.5, 20) translate <0.75, 0, 0.3> pigment { rgb <0.9, 0.85, 0.7> } finish { phong 0.4 } }
