// SPDX-License-Identifier: Apache-2.0
// Glass with Fresnel's reflection and total reflection, colored shadows, facing mirrors that end at max_trace_level, smooth triangles and a
// sky_sphere, for POV-Ray to judge; tests/CMakeLists.txt says how near we come.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 }
camera { location <0, 3, -10> look_at <0, 1, 0> angle 45 }
sky_sphere { pigment { rgb <0.4, 0.55, 0.85> } }
light_source { <-6, 9, -7> rgb 0.8 }
light_source { <5, 6, -4> rgb <0.5, 0.4, 0.3> spotlight point_at <1, 0, 0> radius 12 falloff 25 }
plane { y, 0 pigment { rgb <0.7, 0.7, 0.6> } finish { diffuse 0.7 ambient 0.1 } }
sphere { <-2.6, 1, -1>, 1
  pigment { rgbf <0.9, 1, 0.9, 0.95> } finish { ambient 0 diffuse 0 specular 0.6 roughness 0.01 reflection { 0, 1 fresnel } conserve_energy }
  interior { ior 1.5 } }
// Seen through one face the next reflects totally.
box { <-0.7, 0.02, -0.7>, <0.7, 1.4, 0.7> rotate 50 * y translate <0.2, 0, -1.5>
  pigment { rgbt <1, 0.9, 0.8, 0.9> } finish { ambient 0 diffuse 0.2 phong 0.4 phong_size 60 } interior { ior 1.6 } }
polygon { 5, <-1.5, 0>, <-0.2, 0>, <-0.2, 2.6>, <-1.5, 2.6>, <-1.5, 0> translate <-0.8, 0.1, 1.2> pigment { rgbft <1, 0.4, 0.2, 0.7, 0.1> } }
#declare Mirror = box { <0, 0, -1>, <0.05, 2.4, 1> pigment { rgb <0.2, 0.25, 0.3> } finish { ambient 0.1 diffuse 0.4 reflection 0.75 } }
object { Mirror rotate -20 * y translate <1.6, 0, 1> }
object { Mirror rotate -20 * y translate <3.4, 0, 0.6> }
mesh {
  #declare I = 0;
  #while (I < 8)
    #declare A = vrotate(x, -45 * I * y); #declare B = vrotate(x, -45 * (I + 1) * y);
    smooth_triangle { A, A + 0.6 * y, B, B + 0.6 * y, 1.6 * y, y }
    #declare I = I + 1;
  #end
  pigment { rgb <0.9, 0.5, 0.2> } finish { diffuse 0.8 ambient 0.1 specular 0.5 roughness 0.05 } scale 0.7 translate <2.6, 0, -2.6>
}
sphere { <0.4, 2.6, 2.5>, 0.8 pigment { rgb <0.8, 0.3, 0.4> } finish { brilliance 2 diffuse 0.9 } no_shadow }
