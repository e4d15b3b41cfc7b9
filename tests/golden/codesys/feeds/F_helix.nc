(TIME 6.362265 s: root of 10 pi squared + 5 squared by 5 each second)
N10 G2 X20 Y0 Z-5 I10 J0 F5
