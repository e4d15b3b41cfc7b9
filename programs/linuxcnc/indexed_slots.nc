(INDEXED SLOTS ON THE TABLE)
G21 G90 G17 G40 G49 G80 G94
T1 M6
G43 H1
S5000 M3
G61
#<angle> = 0
o<slot> sub
  G0 X15 Y0
  G0 Z2
  G1 Z-2 F300
  G1 X30 F600
  G1 X15
  G0 Z10
o<slot> endsub
G0 Z10
o1 repeat [6]
  G0 C[#<angle>]
  o<slot> call
  #<angle> = [#<angle> + 60]
o1 endrepeat
G0 C0
M5
M30
