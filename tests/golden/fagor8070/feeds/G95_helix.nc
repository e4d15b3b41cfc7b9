(TIME 19.086795 s: root of 10 pi squared + 5 squared by 0.1 x 1000 each minute)
G95 S1000 M3
G2 X20 Y0 Z-5 I10 J0 F0.1
M30
