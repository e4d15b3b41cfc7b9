F100
o1 if [0]
G1 X1 (never run
o1 endif
M2
