difference { box { -1, 1 } sphere { 0, 1.2 } cylinder { -2*x, 2*x, 0.3 open } pigment { color rgb x } }
intersection { plane { y, 0 } plane { <1, 1, 1>, 1 inverse } cone { -y, 1, y, 0.2 } inverse }
merge { box { 0, 1 } union { box { 1, 2 } torus { 1, 0.2 } } clipped_by { plane { x, 0.5 } } bounded_by { clipped_by } rotate 30 }
difference { plane { z, 3 } mesh { triangle { 0, x, y } triangle { 0, y, z } triangle { 0, z, x } triangle { x, z, y } inside_vector y } }
