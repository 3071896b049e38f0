// SPDX-License-Identifier: AGPL-3.0-or-later
// Two meshes merged in one block of colored glass, and one behind clipped_by.
#include "stage.inc"
#declare Solid = <0.3, 1, 0.1>;
#include "bunny.inc"
#include "armadillo.inc"
camera { location <0.2, 1.4, -3.2> look_at <0, 0.65, 0> angle 44 }
Sun()
Floor()
merge {
    Stand(bunny, 1, 200)
    object { Stand(armadillo, 1.2, 180) translate <0.25, 0.1, 0.1> }
    pigment { rgbf <0.9, 0.6, 0.5, 0.8> }
    finish { specular 0.5 reflection 0.1 }
    interior { ior 1.2 }
    translate -0.6 * x
}
object { Stand(armadillo, 1.3, 160) clipped_by { plane { -z, 0.05 rotate 30 * y } } texture { pigment { rgb <0.3, 0.6, 0.9> } } interior_texture { pigment { rgb <0.9, 0.4, 0.2> } } translate 0.8 * x }
