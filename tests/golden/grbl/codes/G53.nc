G55 G0 X1
G91 G53 G0 Z-10 (absolute all the same)
G90 G53 G1 X3 F200
