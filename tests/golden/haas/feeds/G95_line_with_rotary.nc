O0001
(TIME 26.832816 s: root of 20 squared + 40 squared by 0.1 x 1000 each minute)
G91 G95 S1000 M3
G1 X20. C40. F0.1
M30
