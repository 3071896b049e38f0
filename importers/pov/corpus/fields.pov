blob { threshold 0.5 sphere { 0, 1, 1 } cylinder { 0, x, 0.5, strength -0.4 translate y } component 1, 1, <1, 1, 0> }
quadric { <1, 2, 3>, <0.5, 0, 0>, <0, 0, 0.1>, -1 scale 2 }
poly { 2, <1, 0, 0, 0, 1, 0, 0, 1, 0, -1> }
isosurface { function { x*x + y*y + z*z - 1 } threshold 0.1 contained_by { sphere { 0, 1 } } open }
intersection { quadric { <1, 0, 1>, 0, 0, -1 } plane { y, 1 } plane { -y, 1 } }
box { 0, 1 texture { material_map { png "a.png" once texture { pigment { rgb 1 } } texture { pigment { rgb 0 } } } } }
box { 0, 1 pigment { image_pattern { png "a.png" map_type 1 } warp { spherical orientation y dist_exp 1 } warp { planar x, 2 } warp { toroidal major_radius 2 } } normal { bump_map { png "a.png" bump_size 2 } 0.7 } interior { caustics 1 fade_distance 2 } }
mesh { triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> } uv_mapping pigment { checker rgb 0 rgb 1 } }
#declare Held = box { 0, 1 }
#if (inside(Held, 0.5 * x)) object { Held } #end
