O0001
(TIME 18.849556 s: 10 pi, the arc alone by 0.1 x 1000 each minute)
G91 G95 S1000 M3
G2 X20. Y0. Z-5. I10. J0. F0.1
M30
