// SPDX-License-Identifier: AGPL-3.0-or-later
// Overcast's test scene `plants` as one mesh, seen as from the first frame of its path: timed, not among the ten.
#include "stage.inc"
#include "plants.inc"
#local Low = min_extent(plants);
#local High = max_extent(plants);
#local Middle = (Low + High) / 2;
camera { location Middle + <0.15, 0.12, -0.25> * vlength(High - Low) look_at Middle angle 50 }
Sun()
object { plants pigment { rgb <0.4, 0.6, 0.3> } }
