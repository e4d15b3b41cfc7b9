G21 G90 G17 G40 G80
T1 M6 
G43 H1
S6000 M3
G64 P0.01
#<step> = 1.0
#<level> = 0
G0 X22 Y0 Z5
G1 Z0.5 F500
o100 do
  #<level> = [#<level> - #<step>]
  G3 X22 Y0 Z#<level> I-22 J0 F800
o100 while [#<level> GT -3]
G3 I-22 J0 P2
G1 X24 Y0
G0 Z5
X-10 Y-26
G1 Z-1 F500
G2 X10 R14 F800
G0 Z30
M2
