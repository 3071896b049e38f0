#version 3.7;
#declare Hill = height_field { function 12, 9 { 0.5 + 0.4 * sin(7 * x) * y } smooth water_level 0.2 scale <4, 1, 4> }
object { Hill pigment { image_map { png "none.png" once transmit all 0.5 } } }
#declare N = <0, 0, 0>;
#macro Put(What, On, At) #local P = trace(On, At, -y, N); #if (vlength(N) > 0) object { What translate P } #end #end
union {
  #for (I, 0, 3) Put(sphere { 0, 0.1 }, Hill, <I + 0.5, 9, 1.3>) #end
  texture { tiles { texture { pigment { rgb 1 } } tile2 texture { pigment { rgb x } finish { ambient rgb 0.3 } } } }
  bounded_by { box { -1, 9 } }
}
#fopen Out "points.txt" write
#write (Out, "1, <2, 3, 4>, \"five\"\n", 6, ",", <7, 8>)
#fclose Out
#fopen In "points.txt" read
#read (In, A, B, C)
#while (defined(In)) #read (In, D) #end
#declare Nested = array[2] { array[2] { A, B }, array[1] { C } }
#declare Row = Nested[1]
#if (file_exists("timrom.ttf"))
  #declare Word = text { ttf "timrom" concat("\u0041\u00e9 ", str(A, 0, 1), Row[0]) 0.2, <0.05, 0, 0> }
  object { Word translate max_extent(Word).y * y - min_extent(Hill) }
  text { internal 2 "&\"" 0.1, 0 }
#end
sphere { D * 0.1, 0.2 no_image }
camera { omnimax location <2, 3, -6> look_at 0 }
