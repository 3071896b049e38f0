// SPDX-License-Identifier: Apache-2.0
// A spotlight, parallel light, a light that fades, a shadowless one; phong, specular, metal, mirrors and brilliance, for
// POV-Ray 3.7 to judge; tests/povray_test.cpp compares.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 ambient_light rgb <0.5, 0.6, 0.7> }
camera { location <3, 5, -9> look_at <0, 0.6, 0> angle 42 right x up y }
background { rgb <0.1, 0.15, 0.3> }
light_source { <-4, 6, -5> rgb <0.9, 0.8, 0.7> spotlight point_at <-1, 0, 0> radius 14 falloff 24 tightness 3 }
light_source { <30, 40, -20> rgb 0.35 parallel point_at <0, 0, 0> }
light_source { <2.5, 1.5, -2.5> rgb <0.3, 0.5, 1> fade_distance 2 fade_power 2 }
light_source { <0, 20, -20> rgb 0.1 shadowless }
plane { y, 0 pigment { checker rgb 0.9, rgb <0.2, 0.3, 0.2> } finish { diffuse 0.8 ambient 0.1 reflection 0.08 } }
#default { finish { ambient 0.15 diffuse 0.5 } }
#macro Ball(At, Tint, Shine)
  sphere { At, 0.8 pigment { rgb Tint } finish { Shine } }
#end
Ball(<-2, 0.8, 0>, <1, 0.3, 0.2>, finish { phong 0.9 phong_size 25 })
Ball(<0, 0.8, 1>, <0.9, 0.7, 0.2>, finish { specular 0.8 roughness 0.03 metallic brilliance 3 })
Ball(<2, 0.8, 0>, <0.3, 0.6, 0.9>, finish { reflection { 0.1, 0.8 falloff 3 metallic } })
box { <-0.6, 0.05, -2.6>, <0.6, 1, -1.8> pigment { rgbft <0.4, 0.9, 0.5, 0.5, 0.2> } finish { diffuse 0.6 ambient 0 } no_shadow rotate 20 * y }
