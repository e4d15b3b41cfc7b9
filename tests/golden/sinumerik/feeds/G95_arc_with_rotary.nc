; TIME 6.283185 s: by F0.5 per revolution at 600 1/min
G95 S600 M3
G2 X20 Y0 C40 I10 J0 F0.5
M30
