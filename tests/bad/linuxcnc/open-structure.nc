o100 if [1]
G0 X1
M2
