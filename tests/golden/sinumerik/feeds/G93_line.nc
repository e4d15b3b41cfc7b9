; TIME 30.000000 s: half a minute by F2
G93
G1 X30 Y40 F2
M30
