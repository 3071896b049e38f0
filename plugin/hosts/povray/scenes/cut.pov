// SPDX-License-Identifier: AGPL-3.0-or-later
// Meshes in CSG: differences, an intersection of two, and what is cut out in another texture.
#include "stage.inc"
#declare Solid = <0.1, 1, 0.2>;
#include "bunny.inc"
#include "armadillo.inc"
camera { location <0, 1.3, -3.4> look_at <0, 0.6, 0> angle 45 }
Sun()
Floor()
difference {
    object { Stand(bunny, 1.2, 170) pigment { rgb <0.9, 0.7, 0.4> } }
    sphere { <-0.1, 0.9, -0.35>, 0.4 pigment { wood scale 0.1 } }
    cylinder { <-2, 0.3, 0>, <2, 0.3, 0>, 0.12 pigment { rgb <0.8, 0.1, 0.1> } finish { reflection 0.2 } }
    translate -0.75 * x
}
intersection {
    object { Stand(armadillo, 1.4, 150) pigment { granite scale 0.3 } }
    box { <-2, -1, -2>, <2, 0.95, 2> pigment { rgb <0.2, 0.5, 0.8> } }
    object { Stand(bunny, 1.7, 60) translate -0.2 * y pigment { rgb <0.9, 0.9, 0.3> } }
    translate 0.75 * x
}
