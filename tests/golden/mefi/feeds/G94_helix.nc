"TIME 6.362265 s: root of 10 pi squared + 5 squared by 300 each minute
G94
G2 X20 Y0 Z-5 I10 J0 F300
M30
