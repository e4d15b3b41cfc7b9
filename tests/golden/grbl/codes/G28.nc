G0 X5 Y6 Z7
G28
G0 X5
G91 G28 Z1 (by Z8; X and Y stay)
