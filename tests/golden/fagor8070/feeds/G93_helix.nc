(TIME 4.000000 s: the seconds of F)
G93
G2 X20 Y0 Z-5 I10 J0 F4
M30
