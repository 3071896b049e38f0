// SPDX-License-Identifier: AGPL-3.0-or-later
// Radiosity: rays from every point in all directions.
#include "stage.inc"
#include "buddha.inc"
global_settings { radiosity { count 150 error_bound 0.5 brightness 0.6 recursion_limit 1 always_sample off pretrace_start 0.08 pretrace_end 0.01 } }
camera { location <0, 0.9, -2.4> look_at <0, 0.6, 0> angle 42 }
light_source { <0.6, 1.9, -0.5> rgb 0.5 }
box { <-1.2, 0, -3>, <1.2, 2, 1> hollow inverse texture { pigment { gradient x color_map { [0.3 rgb <0.9, 0.3, 0.2>] [0.7 rgb <0.3, 0.8, 0.3>] } scale 3 translate -1.5 * x } } }
object { Stand(buddha, 1.2, 180) texture { pigment { rgb 0.9 } } }
