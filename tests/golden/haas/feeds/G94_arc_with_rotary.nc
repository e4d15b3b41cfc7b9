O0001
(TIME 10.172434 s: root of 10 pi squared + 40 squared by 300 each minute)
G91 G94
G2 X20. Y0. C40. I10. J0. F300.
M30
