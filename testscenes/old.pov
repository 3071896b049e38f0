// SPDX-License-Identifier: Apache-2.0
// A scene from before #version 3.7: its colors are what screens are told, and POV-Ray writes them as they are.
camera { location <0, 2, -6> look_at <0, 0.5, 0> }
background { color red 0.1 green 0.15 blue 0.3 }
light_source { <-4, 6, -5> color red 1 green 0.9 blue 0.8 }
plane { y, 0 pigment { color rgb 0.6 } }
box { <-2.2, 0.1, -0.5>, <-1.2, 1.1, 0.5> pigment { color rgb <0.7, 0.2, 0.1> } finish { phong 0.5 } }
cylinder { 0.1 * y, 1.3 * y, 0.5 pigment { color rgb <0.2, 0.6, 0.3> } finish { reflection 0.3 } }
cone { <1.6, 0.05, 0>, 0.7, <1.6, 1.4, 0>, 0.1 pigment { color rgbf <0.9, 0.9, 0.2, 0.5> } }
