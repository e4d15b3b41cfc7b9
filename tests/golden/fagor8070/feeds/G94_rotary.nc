(TIME 18.000000 s: 90 deg by 300 each minute)
G94
G1 C90 F300
M30
