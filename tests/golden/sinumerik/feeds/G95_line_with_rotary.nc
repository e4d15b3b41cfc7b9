; TIME 4.000000 s: by F0.5 per revolution at 600 1/min
G95 S600 M3
G1 X20 C40 F0.5
M30
