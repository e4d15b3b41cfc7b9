; TIME 10.000000 s: by F0.5 per revolution at 600 1/min
G95 S600 M3
G1 X30 Y40 F0.5
M30
