// SPDX-License-Identifier: Apache-2.0
// The test scene `glass` with real spheres, for POV-Ray 3.7 to judge; tests/povray_test.cpp compares.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 12 ambient_light rgb 1 }
camera { location <0, 2.2, 7> right -x look_at <0.2, 0.8, 0> angle 38 }
light_source { <-4, 7, 5> rgb 2.6 / pi }
sky_sphere { pigment { function { max(y, 0) } color_map { [0 rgb 0.8] [1 rgb <0.35, 0.5, 0.8>] } } }
box { <-8, -0.01, -8>, <8, 0, 8>
  pigment { checker rgb <0.85, 0.82, 0.72>, rgb <0.12, 0.16, 0.22> translate -0.5 * y }
  finish { diffuse 1 ambient rgb <0.224, 0.248, 0.296> } }
sphere { <-0.7, 1.1, 0.6>, 1
  pigment { rgbf <0.93, 1, 0.96, 0.9> } finish { diffuse 0 ambient 0 reflection 0.08 } interior { ior 1.5 } }
sphere { <1.3, 1, -1.2>, 1
  pigment { rgb 0.3 } finish { diffuse 0.15 ambient rgb 0.15 * <0.16, 0.175, 0.206> reflection 0.85 } }
