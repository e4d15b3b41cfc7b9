G0 X10 Y5
X0 (G0 stays)
