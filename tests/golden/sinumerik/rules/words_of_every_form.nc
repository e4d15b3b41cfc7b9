N10 G1 X10 Y=10+5*2 Z=-SIN(30) F=1EX3
:20 X=IC(5) Y=AC(0)
/0 N30 X50
/3 N40 Y50
N50 AA1: X1 H5
g1x5y6f200
N60 G0 X0 ; a comment (with brackets)
M30
