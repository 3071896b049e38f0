// SPDX-License-Identifier: Apache-2.0
// Holes of image_maps, and objects that only some rays see, for POV-Ray to judge;
// tests/CMakeLists.txt says how near we come.
#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 6 }
camera { location <0, 2.2, -6> look_at <0, 0.9, 0> angle 50 }
light_source { <-6, 9, -8> rgb 1 }
background { rgb <0.5, 0.65, 0.85> }

#declare Plain = finish { ambient 0.15 diffuse 0.75 }
#declare Leaf = pigment { image_map { png "leaf.png" once } }

plane { y, 0 pigment { rgb <0.75, 0.7, 0.6> } finish { Plain } }
// A mirror behind it all.
box { <-3.4, 0, 3>, <3.4, 3, 3.1> pigment { rgb 0.1 } finish { ambient 0 diffuse 0.2 reflection 0.8 } }

// On x and y, turned with the object; and on the texture coordinates of a mesh.
polygon { 5, <0, 0>, <1, 0>, <1, 1>, <0, 1>, <0, 0>
    pigment { Leaf } finish { Plain } scale 2 rotate 25 * y translate <-2.9, 0.02, 0> }
mesh2 {
    vertex_vectors { 4, <0, 0, 0>, <1.6, 0, 0.4>, <1.7, 1.9, 0.3>, <0.1, 2, 0> }
    uv_vectors { 4, <0, 0>, <1, 0>, <1, 1>, <0, 1> }
    face_indices { 2, <0, 1, 2>, <0, 2, 3> }
    uv_mapping pigment { Leaf } finish { Plain } translate <-0.9, 0.02, 0.6>
}
// Repeated, in the wall of a solid.
difference {
    box { <0, 0, 0>, <1.4, 1.4, 0.1> }
    cylinder { <0.7, 0.7, -1>, <0.7, 0.7, 1>, 0.25 }
    pigment { image_map { png "leaf.png" } scale 0.35 } finish { Plain }
    rotate -20 * y translate <1, 0.02, -0.9>
}

sphere { <-1.5, 0.4, -1.9>, 0.35 pigment { rgb <0.9, 0.2, 0.15> } finish { Plain } no_shadow }
sphere { <-0.4, 0.4, -1.9>, 0.35 pigment { rgb <0.2, 0.7, 0.2> } finish { Plain } no_image }
sphere { <0.6, 0.4, -2>, 0.35 pigment { rgb <0.2, 0.3, 0.9> } finish { Plain } no_reflection }
