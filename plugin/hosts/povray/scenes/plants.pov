// SPDX-License-Identifier: AGPL-3.0-or-later
// Overcast's test scene `plants` as one mesh, from where its path begins: timed, not among the ten.
#include "stage.inc"
#include "plants.inc"
#local Eye = trace(plants, <0, 500, 4>, -y) + 2.3 * y;
camera { location Eye right -x * image_width / image_height look_at <-9, Eye.y - 2.6, -40> angle 60 }
light_source { <6300, 3000, 3600> rgb <1.3, 1, 0.65> }
light_source { <-500, 3000, 300> rgb 0.3 shadowless }
sky_sphere { pigment { gradient y color_map { [0 rgb <0.75, 0.8, 0.85>] [1 rgb <0.2, 0.35, 0.7>] } } }
object { plants pigment { rgb <0.5, 0.65, 0.4> } finish { reflection 0.05 } }
