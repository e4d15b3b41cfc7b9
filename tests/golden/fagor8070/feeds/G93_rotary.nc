(TIME 4.000000 s: the seconds of F)
G93
G1 C90 F4
M30
