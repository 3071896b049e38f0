#version 3.7;
global_settings { assumed_gamma 1 max_trace_level 7 ambient_light rgb 0.5 }
#default { finish { ambient 0.2 diffuse 0.7 } }
#macro Row(N, Step, Last)
  #local I = 0;
  #while (I < N)
    #if (mod(I, 2) = 0) box { <I, 0, 0> * Step, <I + 0.5, 1, 1> }
    #else sphere { <I, 0, 0>, 0.4 } #end
    #declare Last = I;
    #local I = I + 1;
  #end
#end
#declare Count = 0;
union { Row(4, 1.5, Count) pigment { color rgb <1, 0.5, 0.2> filter 0.1 } rotate 30 * y }
#for (J, 1, 3)
  #switch (J) #case (1) cone { 0, 1, y, 0.2 } #break #range (2, 2) torus { 2, 0.3 } #break #else disc { 0, y, 1, 0.5 } #end
#end
#declare A = array[2][2] { { 1, 2 }, { 3, vlength(<3, 4, 0>) } }
#ifdef (A) triangle { 0, A[0][1] * x, y * A[1][1] } #end
#declare F = function (a, b) { pow(a, 2) + select(b, 1, 2, 3) }
#declare S = spline { cubic_spline 0, <0, 0>, 1, <1, 2>, 2, <0, 3>, 3, <4, 4> }
#declare T = transform { rotate <10, 20, 30> translate S(1.5) * F(2, -1) inverse }
object { sphere { 0, 1 } transform T texture { pigment { checker rgb 1, rgb 0 scale 0.3 } } }
