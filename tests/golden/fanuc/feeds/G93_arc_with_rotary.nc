O0001
(TIME 94.247780 s: 10 pi by F x radius = 20 each minute)
G91 G93
G2 X20. Y0. C40. I10. J0. F2.
M30
