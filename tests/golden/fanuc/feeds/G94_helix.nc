O0001
(TIME 6.283185 s: 10 pi, the arc alone by 300 each minute)
G91 G94
G2 X20. Y0. Z-5. I10. J0. F300.
M30
