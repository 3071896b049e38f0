// SPDX-License-Identifier: AGPL-3.0-or-later
// One large mesh, marbled, over a mirroring floor: the scene that is timed.
#include "stage.inc"
#include "dragon.inc"
camera { location <0, 1.1, -2.6> look_at <0, 0.62, 0> angle 42 }
Sun()
Floor()
object {
    Stand(dragon, 1.4, 0)
    texture { pigment { marble turbulence 0.6 color_map { [0 rgb <0.2, 0.5, 0.35>] [1 rgb <0.9, 0.95, 0.8>] } scale 0.3 } finish { specular 0.5 reflection 0.1 } }
}
