blob { threshold 0.5 sphere { 0, 1, 1 } cylinder { 0, x, 0.5, strength -0.4 translate y } component 1, 1, <1, 1, 0> }
quadric { <1, 2, 3>, <0.5, 0, 0>, <0, 0, 0.1>, -1 scale 2 }
poly { 2, <1, 0, 0, 0, 1, 0, 0, 1, 0, -1> }
isosurface { function { x*x + y*y + z*z - 1 } threshold 0.1 contained_by { sphere { 0, 1 } } open }
intersection { quadric { <1, 0, 1>, 0, 0, -1 } plane { y, 1 } plane { -y, 1 } }
