O0001
(TIME 8.944272 s: root of 20 squared + 40 squared by 300 each minute)
G91 G94
G1 X20. C40. F300.
M30
