; TIME 30.000000 s: half a minute by F2
G93
G2 X20 Y0 Z-5 I10 J0 F2
M30
