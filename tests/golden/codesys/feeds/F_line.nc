(TIME 10.000000 s: 50 by 5 each second)
N10 G1 X30 Y40 F5
