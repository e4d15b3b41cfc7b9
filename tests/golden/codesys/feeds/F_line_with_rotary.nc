(TIME 4.000000 s: 20 by 5 each second)
N10 G1 X20 C40 F5
