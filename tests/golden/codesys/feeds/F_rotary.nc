(TIME 18.000000 s: 90 deg by 5 each second)
N10 G1 C90 F5
