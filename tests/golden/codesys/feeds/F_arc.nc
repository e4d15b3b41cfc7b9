(TIME 6.283185 s: 10 pi by 5 each second)
N10 G2 X20 Y0 I10 J0 F5
