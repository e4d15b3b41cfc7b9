O0001
(TIME 30.517303 s: root of 10 pi squared + 40 squared by 0.1 x 1000 each minute)
G91 G95 S1000 M3
G2 X20. Y0. C40. I10. J0. F0.1
M30
