(PLATE WITH FOUR HOLES)
G21 G17 G40 G49 G80 G90 G94
G64 P0.02
#<depth> = -8.0
#<clear> = 2.0
o<holes> sub
  G0 X-15 Y-10
  G98
  o10 if [#1 EQ 1]
    G81 X-15 Y-10 Z-1 R#2 F300
  o10 elseif [#1 EQ 2]
    G83 X-15 Y-10 Z#3 R#2 Q3 F240
  o10 else
    G73 X-15 Y-10 Z#3 R#2 Q2.5 F240
  o10 endif
  X15
  Y10
  X-15
  G80
o<holes> endsub
T1 M6
G43 H1
S2500 M3
G0 Z15
o<holes> call [1] [#<clear>]
G0 Z30
T2 M6
G43 H2
S2000 M3
G0 Z15
o<holes> call [2] [#<clear>] [#<depth>]
G0 Z30
T1 M6
G43 H1
G0 X0 Y0 Z15
S400 M3
G98 G84 X0 Y0 Z-6 R2 F400
G80
M5
G0 Z30
M2
