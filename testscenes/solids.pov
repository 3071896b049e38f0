// Solids: differences, intersections, merges and clips, for tests/povray_test.cpp. No two surfaces
// coincide: POV-Ray draws those in speckles.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -8> right x look_at <0, 0, 0> }
light_source { <-10, 20, -20>, 1 shadowless }
background { color rgb <0.2, 0.3, 0.5> }

#declare Rods = union {
    cylinder { -2*x, 2*x, 0.7 }
    cylinder { -2*y, 2*y, 0.7 }
    cylinder { -2*z, 2*z, 0.7 }
}

// Three looks, and a union taken away.
difference {
    intersection {
        box { -1, 1 pigment { color rgb <1, 0.3, 0.2> } }
        sphere { 0, 1.35 pigment { color rgb <0.2, 0.4, 1> } }
    }
    object { Rods pigment { color rgb <0.3, 0.9, 0.3> } }
    rotate 30*y
    translate <-2, 0.6, 0>
}

// A difference taken away leaves its core.
difference {
    box { -1, 1 }
    difference {
        box { <-2, -0.5, -0.6>, <2, 2, 0.6> }
        cylinder { <0, -1, 0>, <0, 3, 0>, 0.4 }
        pigment { color rgb <1, 1, 0.2> }
    }
    pigment { color rgb 0.8 }
    rotate -25*y
    translate <1, -1.2, -1.5>
}

// Half-spaces, one of them inverse.
intersection {
    sphere { 0, 1.2 }
    plane { y, 0.3 }
    plane { <-1, 1, 0>, 0.2 inverse }
    pigment { color rgb <1, 0, 1> }
    finish { phong 1 }
    translate <2.5, 1.5, 1>
}

// Without inner surfaces, which would show.
merge {
    sphere { 0, 0.8 }
    sphere { x, 0.8 }
    pigment { color rgbt <1, 1, 0.8, 0.6> }
    finish { ambient 0.3 }
    translate <-1, 2.5, 2>
}

// Shells, seen from inside too.
sphere {
    0, 1
    clipped_by { plane { x + y - z, 0 } }
    pigment { color rgb <0, 1, 1> }
    translate <3.2, -0.6, 0>
}
difference {
    cone { 0, 1, 2*y, 0.4 open }
    box { <-2, 0.5, -2>, <2, 1, -0.3> pigment { color rgb <1, 0.5, 0> } }
    pigment { color rgb <0.5, 0.5, 1> }
    translate <-3, -2, -0.5>
}
