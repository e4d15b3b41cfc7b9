G0 X1
o1 return
M2
