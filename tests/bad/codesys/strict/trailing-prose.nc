N10 G1 X10 F100 first straight line
