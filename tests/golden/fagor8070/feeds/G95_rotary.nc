(TIME 54.000000 s: 90 deg by 0.1 x 1000 each minute)
G95 S1000 M3
G1 C90 F0.1
M30
