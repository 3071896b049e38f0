camera { orthographic location <3, 4, -9> look_at <0, 0.5, 0> angle 40 sky <0.1, 1, 0> right 1.6 * x }
light_source { <5, 9, -6>, rgb 1 spotlight point_at 0 radius 12 falloff 20 tightness 2 fade_distance 9 fade_power 2 }
background { color red 0.2 green 0.3 blue 0.4 }
plane { <0, 2, 0>, -1 hollow on pigment { bozo color_map { [0 rgb 0] [0.4 0.6 color rgb 1 color rgb 0.5] [1 rgbt <1, 0, 0, 0.5>] } turbulence 0.4 } }
superellipsoid { <0.3, 0.5> finish { phong 0.8 phong_size 90 reflection { 0.1, 0.9 fresnel on } conserve_energy } interior { ior 1.5 } }
lathe { bezier_spline 4, <0, 0>, <1, 0.2>, <0.3, 1>, <0.5, 2> }
sor { 5, <0.2, -0.5> <0.4, 0> <0.3, 0.5> <0.6, 1> <0.4, 1.5> open no_shadow }
prism { linear_sweep cubic_spline 0, 1, 7, <0, 0>, <1, 0>, <1, 1>, <0.5, 1.4>, <0, 1>, <1, 0>, <1, 1> }
polygon { 10, <0, 0>, <3, 0>, <3, 3>, <0, 3>, <0, 0>, <1, 1>, <1, 2>, <2, 2>, <2, 1>, <1, 1> }
bicubic_patch { type 1 flatness 0.1 u_steps 2 v_steps 2 <0, 0, 0>, <1, 0, 0>, <2, 0, 0>, <3, 0, 0>, <0, 1, 0>, <1, 1, 1>, <2, 1, 1>, <3, 1, 0>, <0, 2, 0>, <1, 2, 1>, <2, 2, 1>, <3, 2, 0>, <0, 3, 0>, <1, 3, 0>, <2, 3, 0>, <3, 3, 0> }
mesh2 { vertex_vectors { 4, 0, x, y, z } normal_vectors { 1, y } texture_list { 1, texture { pigment { rgb x } } } face_indices { 2, <0, 1, 2>, 0, <0, 2, 3> } normal_indices { 2, <0, 0, 0>, <0, 0, 0> } }
mesh { triangle { 0, x, z } smooth_triangle { 0, y, x, y, z, y texture { pigment { rgb y } } } scale <2, -1, 1> }
merge { cylinder { -y, y, 0.3 open } sphere { y, 0.4 inverse } matrix <1, 0, 0, 0.2, 1, 0, 0, 0, 1, 4, 5, 6> }
julia_fractal { <-0.08, 0, -0.83, -0.03> quaternion cube max_iteration 3 precision 20 slice <0, 0, 0.1, 1>, 0.1 }
