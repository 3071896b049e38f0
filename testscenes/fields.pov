// Implicit surfaces, alone and as parts of solids, for tests/povray_test.cpp.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -9> right x look_at <0, 0.5, 0> }
light_source { <-10, 20, -20>, 1 shadowless }
background { color rgb <0.2, 0.3, 0.5> }

blob {
    threshold 0.6
    sphere { <-0.5, 0, 0>, 1, 1 }
    sphere { <0.6, 0, 0>, 1, strength 1 }
    cylinder { <0, -1, 0>, <0, 1.6, 0>, 0.5, 1.2 rotate 10*z }
    sphere { <0, 0, -0.6>, 0.8, -1.5 }
    pigment { color rgb <1, 0.5, 0.2> }
    finish { phong 0.8 }
    translate <-2.6, 1, 0>
}
quadric { // an ellipsoid at an angle
    <1, 2, 3>, <0.5, 0, 0.2>, <0, 0, 0.1>, -1
    pigment { color rgb <0.2, 0.4, 1> }
    translate <0, 2.4, 0>
}
intersection { // a waist
    quadric { <1, -1, 1>, <0, 0, 0>, <0, 0, 0>, -0.1 }
    plane { y, 1 }
    plane { -y, 1 }
    pigment { color rgb <1, 0.2, 0.4> }
    translate <0, -0.3, 0>
}
quartic { // a torus
    <1, 0, 0, 0, 2, 0, 0, 2, 0, -1.7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
     1, 0, 0, 2, 0, -1.7, 0, 0, 0, 0, 1, 0, 1.3, 0, 0.35>
    pigment { color rgb <0.9, 0.9, 0.2> }
    rotate 70*x
    translate <2.6, 2, 0>
}
isosurface { // its cut faces belong to the box
    function { x*x + y*y + z*z - 1 + 0.3*sin(10*x)*sin(10*y)*sin(10*z) }
    contained_by { box { -<1, 1.2, 1>, <1, 0.6, 1.2> } }
    max_gradient 8
    pigment { color rgb <0.3, 1, 0.9> }
    translate <2.4, -0.6, -1>
}
isosurface { // a sheet
    function { y - 0.3*sin(5*x)*cos(5*z) }
    contained_by { sphere { 0, 1.2 } }
    open
    max_gradient 4
    pigment { color rgb <0.9, 0.4, 0.9> }
    translate <-2.2, -0.6, -1.5>
}
difference {
    blob { threshold 0.5 sphere { 0, 1.5, 1 } sphere { x, 1.2, 1 } }
    box { <-2, -2, -2>, <2, 2, -0.2> pigment { color rgb <0.6, 0.3, 0.1> } }
    pigment { color rgb 0.7 }
    scale 0.8
    rotate 30*y
    translate <-0.3, -0.6, -2>
}
