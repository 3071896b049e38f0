// SPDX-License-Identifier: AGPL-3.0-or-later
// Some hundred copies of one mesh, each with its own transform: sheared, mirrored, of all sizes.
#include "stage.inc"
#include "dragon_small.inc"
camera { location <0, 3, -6> look_at <0, 0.3, 0> angle 50 }
Sun()
plane { y, 0 pigment { rgb <0.5, 0.6, 0.4> } }
#local One = Stand(dragon_small, 0.5, 0)
#local Luck = seed(5);
#for (X, -8, 8)
    #for (Z, -5, 12)
        object {
            One
            scale <0.6 + 0.7 * rand(Luck), 0.5 + rand(Luck), 0.6 + 0.7 * rand(Luck) * (mod(X + 8, 3) = 0 ? -1 : 1)>
            matrix <1, 0, 0, 0.3 * rand(Luck), 1, 0.2 * rand(Luck), 0, 0, 1, 0, 0, 0>
            rotate 360 * rand(Luck) * y
            translate <0.8 * X, 0, 0.8 * Z>
            texture { pigment { rgb <rand(Luck), rand(Luck), 0.6> } finish { reflection 0.2 * rand(Luck) specular 0.3 } }
        }
    #end
#end
