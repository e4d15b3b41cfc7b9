(TIME 4.000000 s: the seconds of F)
G93
G1 X30 Y40 F4
M30
