; TIME 30.000000 s: half a minute by F2
G93
G1 C40 F2
M30
